// The compiler as one call: takes RSL and its configuration, returns an image and diagnostics.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "compiler/config/algorithm_modules.hpp"
#include "compiler/config/boards.hpp"
#include "compiler/config/robot.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/input.hpp"
#include "compiler/lints.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/test_plan/plan.hpp"

namespace robosync::compiler {

struct Reading;  // reading.hpp

struct Options {
  bool source_lines = true;  // keep the debug section
  bool optimize = true;
  std::uint32_t seed = 0;  // for random numbers; overrides the configuration's; 0: none
  LintLevels lints{};      // override those of robot.json
  ModuleReader read_module{};
  AlgorithmModules algorithms{};  // those that robot.json may name
};

struct Result {
  SourceMap sources;
  Diagnostics diagnostics;
  std::vector<std::byte> image;  // empty when there are errors
  std::vector<Span> rules;       // where the source of each rule is
  WrittenUnits units;            // of the names in the image
  test_plan::TestPlan tests;     // the program's TEST blocks; empty if analysis fails
  Board board;                   // the one that robot.json names, or the default
  std::shared_ptr<const Reading>
      reading;  // for editors (query/); never null, holds views of `sources`
};

[[nodiscard]] Result compile(Input program, Input configuration, const Options& options = {});

}  // namespace robosync::compiler
