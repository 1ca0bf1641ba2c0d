// The compiler as one call: RSL and its configuration in, an image and diagnostics out.
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
  std::uint32_t seed = 0;  // of the random numbers, in the place of the configuration's; 0: none
  LintLevels lints{};      // above what robot.json says
  ModuleReader read_module{};
  AlgorithmModules algorithms{};  // that robot.json may name
};

struct Result {
  SourceMap sources;
  Diagnostics diagnostics;
  std::vector<std::byte> image;  // empty when there are errors
  std::vector<Span> rules;       // where each rule of the image is written
  WrittenUnits units;            // of what the image names
  test_plan::TestPlan tests;     // the program's TEST blocks; likewise
  Board board;                   // that robot.json names, or the default one
  std::shared_ptr<const Reading>
      reading;  // what editors ask (query/); never null, views of `sources`
};

[[nodiscard]] Result compile(Input program, Input configuration, const Options& options = {});

}  // namespace robosync::compiler
