// The compiler as one call: RSL and its configuration in, an image and diagnostics out.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compiler/config/boards.hpp"
#include "compiler/config/robot.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/test_plan/plan.hpp"

namespace robosync::compiler {

struct Input {
  std::string name;  // as it shall stand in messages
  std::string text;
};

// What `USE "file"` in the file called `user` means: the module with the name of its own, the same
// for the same file. Nothing when it cannot be read. The compiler itself opens no files.
using ModuleReader =
    std::function<std::optional<Input>(const std::string& user, const std::string& file)>;

struct Options {
  bool source_lines = true;  // keep the debug section
  bool optimize = true;
  std::uint32_t seed = 0;  // of the random numbers, in the place of the configuration's; 0: none
  bool hash = true;        // name the program in the image; who only checks it needs no name
  ModuleReader read_module{};
};

struct Result {
  SourceMap sources;
  Diagnostics diagnostics;
  std::vector<std::byte> image;  // empty when there are errors
  std::vector<Span> rules;       // where each rule of the image is written
  WrittenUnits units;            // of what the image names
  test_plan::TestPlan tests;     // the program's TEST blocks; likewise
  Board board;                   // that robot.json names, or the default one
};

[[nodiscard]] Result compile(Input program, Input configuration, const Options& options = {});

}  // namespace robosync::compiler
