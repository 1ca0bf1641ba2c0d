// The passes in order. Each collects diagnostics; the next runs if its input is usable.
#include "compiler/compiler.hpp"

#include <algorithm>

#include "compiler/codegen/emit.hpp"
#include "compiler/codegen/verify_image.hpp"
#include "compiler/lints.hpp"
#include "compiler/modules.hpp"
#include "compiler/optimize/optimize.hpp"
#include "compiler/reading.hpp"
#include "compiler/sema/analyze.hpp"

namespace robosync::compiler {
namespace {

// An unknown name may be defined in a module that the program does not use.
Diagnostics offer_modules(const Diagnostics& diagnostics) {
  Diagnostics result;
  for (Diagnostic diagnostic : diagnostics.all()) {
    const std::string_view module =
        diagnostic.unknown.empty() ? std::string_view() : module_with(diagnostic.unknown);
    if (!module.empty()) {
      diagnostic.fixes.clear();
      diagnostic.help = {"the module `" + std::string(module) + "` has it: write `USE " +
                         std::string(module) + "` at the top"};
    }
    result.add(std::move(diagnostic));
  }
  return result;
}

// Drops the warning about a missing algorithm file where an error at the same place says more.
Diagnostics without_warned(const Diagnostics& diagnostics) {
  Diagnostics result;
  for (const Diagnostic& one : diagnostics.all()) {
    if (one.code != Code::W0214) {
      result.add(one);
      continue;
    }
    const bool is_told = std::ranges::any_of(diagnostics.all(), [&one](const Diagnostic& other) {
      if (other.level != Level::error || other.labels.empty()) return false;
      const Span shown = other.labels.back().span, here = one.labels.front().span;
      return shown.file == here.file && shown.begin == here.begin;
    });
    if (!is_told) result.add(one);
  }
  return result;
}

}  // namespace

Result compile(Input program, Input configuration, const Options& options) {
  Result result;
  Diagnostics& diagnostics = result.diagnostics;
  const auto reading = std::make_shared<Reading>(
      read_all(std::move(program), std::move(configuration), options.read_module,
               options.algorithms, result.sources, diagnostics));
  result.reading = reading;
  const Reading& parsed = *reading;
  result.board = board_for(parsed.robot ? parsed.robot->board : std::nullopt);
  ir::Program written;
  if (parsed.complete) {
    written = analyze(parsed.trees(), *parsed.robot, result.sources, diagnostics);
    for (const ir::LearnedWord& word : written.words)
      reading->robot->sensors[word.channel.sensor].channels[word.channel.channel].add_label(
          word.text);
    if (diagnostics.errors() > 0) diagnostics = without_warned(offer_modules(diagnostics));
    if (diagnostics.errors() == 0)
      result.tests = test_plan::plan_tests(parsed.trees(), *parsed.robot, diagnostics);
  }
  apply_lints(diagnostics, result.sources, parsed.robot ? &*parsed.robot : nullptr, options.lints);
  if (parsed.complete && diagnostics.errors() == 0) {
    const Robot& robot = *parsed.robot;
    const ir::Program better = options.optimize ? optimize(written, robot) : written;
    Emitted emitted =
        emit(better, written, robot, {.source_lines = options.source_lines, .seed = options.seed},
             diagnostics);
    if (diagnostics.errors() == 0 && verify_image(emitted, diagnostics)) {
      result.image = std::move(emitted.image);
      result.rules = std::move(emitted.rules);
      result.units = units_of(robot);
      for (const ir::Variable& variable : written.variables)
        result.units.variables[variable.name] = variable.unit;
    }
  }
  diagnostics.doubt_names(result.sources);
  diagnostics.finish();
  return result;
}

}  // namespace robosync::compiler
