#include "compiler/reading.hpp"

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

// What the parsers had to leave out would be missed by name, and what robot.json says wrongly would be measured wrongly:
// better one true message than ten.
Reading read_all(Input program, Input configuration, const ModuleReader& read_module,
                 const AlgorithmModules& algorithms, SourceMap& sources, Diagnostics& diagnostics) {
  const FileId program_file = sources.add(std::move(program.name), std::move(program.text));
  const FileId configuration_file =
      sources.add(std::move(configuration.name), std::move(configuration.text));
  Reading reading;
  Diagnostics of_robot;  // its mistakes are none of the program's
  reading.robot = read_robot(sources, configuration_file, of_robot, algorithms);
  std::optional<RobotVocabulary> names;
  if (reading.robot) names.emplace(*reading.robot);
  const Vocabulary* const robot = names ? &*names : nullptr;
  reading.tree = parse(sources, program_file, diagnostics, robot);
  reading.modules = load_modules(reading.tree, sources, read_module, diagnostics, robot);
  const bool whole_trees = diagnostics.errors() == 0;
  for (const Diagnostic& diagnostic : of_robot.all())
    diagnostics.add(diagnostic);
  reading.complete = whole_trees && reading.robot && reading.robot->complete;
  return reading;
}

}  // namespace robosync::compiler
