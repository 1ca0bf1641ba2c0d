// The examples, and what becomes of one when its program or its robot.json is changed.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "compiler/compiler.hpp"
#include "rsc/algorithm_modules.hpp"
#include "tests/support/golden.hpp"

namespace robosync::compiler::testing {

struct Example {
  std::string name, program, robot;
};

inline const std::filesystem::path kExamples =
    std::filesystem::path(ROBOSYNC_SOURCE_DIR) / "examples";

inline std::vector<Example> examples() {
  namespace fs = std::filesystem;
  std::vector<Example> found;
  for (const auto& entry : fs::directory_iterator(kExamples))
    if (fs::exists(entry.path() / "robot.rsl"))
      found.push_back({entry.path().filename().string(),
                       robosync::testing::read_file(entry.path() / "robot.rsl"),
                       robosync::testing::read_file(entry.path() / "robot.json")});
  std::ranges::sort(found, {}, &Example::name);
  return found;
}

// The file of words that an example names: the first with that name, since these texts lie in no folder.
inline WordsInFile words_in_example(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(kExamples))
    if (fs::is_regular_file(entry.path() / name, error))
      return robosync::tool::algorithm_modules().words_in_file((entry.path() / name).string());
  return {{}, "is not there"};
}

inline Result compiled(std::string program, std::string robot) {
  AlgorithmModules modules = robosync::tool::algorithm_modules();
  modules.words_in_file = words_in_example;
  return compile({"robot.rsl", std::move(program)}, {"robot.json", std::move(robot)},
                 {.source_lines = false, .algorithms = modules});
}

}  // namespace robosync::compiler::testing
