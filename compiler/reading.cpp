#include "compiler/reading.hpp"

#include <utility>

#include "compiler/config/robot_reader.hpp"
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
  reading.tree = parse(sources, program_file, diagnostics);
  reading.modules = load_modules(reading.tree, sources, read_module, diagnostics);
  const bool whole_trees = diagnostics.errors() == 0;
  reading.robot = read_robot(sources, configuration_file, diagnostics, algorithms);
  reading.complete = whole_trees && reading.robot && reading.robot->complete;
  return reading;
}

}  // namespace robosync::compiler
