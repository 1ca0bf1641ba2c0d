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
    bool is_motion = false;
    const std::string_view module = diagnostic.unknown.empty()
                                        ? std::string_view()
                                        : module_with(diagnostic.unknown, &is_motion);
    if (!module.empty()) {
      const bool performs = is_motion && diagnostic.in_verb_place;
      diagnostic.fixes.clear();
      diagnostic.help = {"the module `" + std::string(module) + "` has it" +
                         (performs ? ", as a MOTION" : "") + ": write `USE " + std::string(module) +
                         "` at the top" +
                         (performs ? ", and here `PERFORM " + diagnostic.unknown + "`" : "")};
    }
    result.add(std::move(diagnostic));
  }
  return result;
}

bool is_clash_with_module(const Diagnostic& one) {
  return one.code == Code::E0101 && one.labels.size() == 2 &&
         one.labels[0].span.file == kProgramFile && one.labels[1].span.file != kProgramFile &&
         one.labels[1].span.file != kConfigurationFile;
}

// A name of the program that a module has too: names the module. What is wrong with that name in the module is a consequence.
Diagnostics without_clashes(const Diagnostics& diagnostics, const SourceMap& sources) {
  constexpr std::size_t kMostClashes = 20;  // each is looked for in every message
  std::vector<std::pair<FileId, std::string>> clashes;
  for (const Diagnostic& one : diagnostics.all())
    if (clashes.size() < kMostClashes && is_clash_with_module(one)) {
      const Span other = one.labels[1].span;
      clashes.emplace_back(other.file, "`" + std::string(sources.text(other)) + "`");
    }
  const auto quotes_clash = [&](const Diagnostic& one) {
    if (one.code == Code::E0101 || one.labels.empty()) return false;
    return std::ranges::any_of(clashes, [&](const auto& clash) {
      const auto& [file, name] = clash;
      return one.labels.front().span.file == file && one.message.find(name) != std::string::npos;
    });
  };
  Diagnostics result;
  for (Diagnostic one : diagnostics.all()) {
    if (quotes_clash(one)) continue;
    if (is_clash_with_module(one)) {
      std::string module(sources.file(one.labels[1].span.file).name());
      std::erase_if(module, [](char c) { return c == '<' || c == '>'; });
      one.labels[1].text = "the module `" + module + "`, which you use, has this name too";
    }
    result.add(std::move(one));
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

void learn_words(const ir::Program& written, Robot& robot) {
  for (const ir::LearnedWord& word : written.words)
    robot.sensors[word.channel.sensor].channels[word.channel.channel].add_label(word.text);
}

// The LIMITs of the program, for those who ask about its robot: `rsc explain` and editors.
void take_limits(const ir::Program& written, Robot& robot) {
  for (const auto& [place, speed] : written.speed_limits)
    robot.actuators[place].speed_limit = speed;
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
    learn_words(written, *reading->robot);
    if (diagnostics.has_errors())
      diagnostics = without_clashes(without_warned(offer_modules(diagnostics)), result.sources);
    if (!diagnostics.has_errors())
      result.tests =
          test_plan::plan_tests(parsed.trees(), *parsed.robot, result.sources, diagnostics);
  }
  apply_lints(diagnostics, result.sources, parsed.robot ? &*parsed.robot : nullptr, options.lints);
  if (parsed.complete && !diagnostics.has_errors()) {
    const Robot& robot = *parsed.robot;
    const ir::Program better = options.optimize ? optimize(written, robot) : written;
    Emitted emitted =
        emit(better, written, robot, {.source_lines = options.source_lines, .seed = options.seed},
             diagnostics);
    if (!diagnostics.has_errors() && verify_image(emitted, diagnostics)) {
      result.image = std::move(emitted.image);
      result.rules = std::move(emitted.rules);
      result.units = units_of(robot);
      for (const ir::Variable& variable : written.variables)
        result.units.variables[variable.name] = variable.unit;
    }
  }
  if (reading->robot) take_limits(written, *reading->robot);
  diagnostics.doubt_names(result.sources);
  diagnostics.finish();
  return result;
}

}  // namespace robosync::compiler
