// The examples, and what becomes of one when its program or its robot.json is changed.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "compiler/compiler.hpp"
#include "rsc/algorithm_modules.hpp"
#include "tests/support/golden.hpp"

namespace robosync::compiler::testing {

struct Example {
  std::string name, program, robot;
};

inline std::vector<Example> examples() {
  namespace fs = std::filesystem;
  std::vector<Example> found;
  for (const auto& entry : fs::directory_iterator(fs::path(ROBOSYNC_SOURCE_DIR) / "examples"))
    // One with words of one's own is compiled together with their file, and these texts have none.
    if (fs::exists(entry.path() / "robot.rsl") && entry.path().filename() != "pocket_pet")
      found.push_back({entry.path().filename().string(),
                       robosync::testing::read_file(entry.path() / "robot.rsl"),
                       robosync::testing::read_file(entry.path() / "robot.json")});
  std::ranges::sort(found, {}, &Example::name);
  return found;
}

inline Result compiled(std::string program, std::string robot) {
  return compile({"robot.rsl", std::move(program)}, {"robot.json", std::move(robot)},
                 {.source_lines = false, .algorithms = robosync::tool::algorithm_modules()});
}

}  // namespace robosync::compiler::testing
