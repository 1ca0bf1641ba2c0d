#include "compiler/reading.hpp"

#include <string>
#include <string_view>
#include <utility>

#include "compiler/config/robot_reader.hpp"
#include "compiler/config/robot_vocabulary.hpp"
#include "compiler/syntax/parser.hpp"

namespace robosync::compiler {

Trees Reading::trees() const {
  Trees trees{&tree};
  for (const Module& module : modules)
    trees.push_back(module.tree.get());
  return trees;
}

namespace {

// Detects `rsc run robot.json`: read as RSL, every line would be a mistake. No line of RSL begins with a bracket.
bool is_configuration(const SourceMap& sources, FileId file, Diagnostics& diagnostics) {
  constexpr std::string_view kSpaces = " \t\r\n";
  constexpr std::string_view kJson = ".json";
  const std::string_view text = sources.file(file).text();
  const std::size_t begin = text.find_first_not_of(kSpaces);
  if (begin == std::string_view::npos || text[begin] != '{') return false;
  const std::size_t next = text.find_first_not_of(kSpaces, begin + 1);
  if (next == std::string_view::npos || (text[next] != '"' && text[next] != '}')) return false;
  std::string name = sources.file(file).name();
  const bool is_json = name.ends_with(kJson);
  if (is_json) name.replace(name.size() - kJson.size(), kJson.size(), ".rsl");
  const auto place = static_cast<std::uint32_t>(begin);
  diagnostics.report(Code::E0001, "this is a JSON configuration, not a program")
      .label({file, place, place + 1})
      .helps(is_json ? "name the program, such as `" + name +
                           "`: rsc finds the robot's description automatically"
                     : "the robot's description goes in a file of its own, robot.json");
  return true;
}

}  // namespace

// Analysis goes on only when both inputs are complete. Names in the parts that the parsers left out would be reported as
// unknown, and a mistake in robot.json would cause wrong messages about values: better one true message than ten.
Reading read_all(Input program, Input configuration, const ModuleReader& read_module,
                 const AlgorithmModules& algorithms, SourceMap& sources, Diagnostics& diagnostics) {
  const FileId program_file = sources.add(std::move(program.name), std::move(program.text));
  const FileId configuration_file =
      sources.add(std::move(configuration.name), std::move(configuration.text));
  Reading reading;
  Diagnostics of_robot;  // kept apart: they do not count as mistakes of the program
  reading.robot = read_robot(sources, configuration_file, of_robot, algorithms);
  std::optional<RobotVocabulary> names;
  if (reading.robot) names.emplace(*reading.robot);
  const Vocabulary* const robot = names ? &*names : nullptr;
  if (is_configuration(sources, program_file, diagnostics)) return reading;
  reading.tree = parse(sources, program_file, diagnostics, robot);
  reading.modules = load_modules(reading.tree, sources, read_module, diagnostics, robot);
  const bool whole_trees = !diagnostics.has_errors();
  for (const Diagnostic& diagnostic : of_robot.all())
    diagnostics.add(diagnostic);
  reading.complete = whole_trees && reading.robot && reading.robot->complete;
  return reading;
}

}  // namespace robosync::compiler
