// A program, the modules that it uses and its robot.json, as read, before anything in them is resolved.
#pragma once

#include <optional>
#include <vector>

#include "compiler/config/algorithm_modules.hpp"
#include "compiler/config/robot.hpp"
#include "compiler/input.hpp"
#include "compiler/modules.hpp"
#include "compiler/sema/names.hpp"
#include "compiler/syntax/ast.hpp"

namespace robosync::compiler {

struct Reading {
  ast::Tree tree;
  std::vector<Module> modules;
  std::optional<Robot> robot;  // nothing when it is unusable
  bool complete = false;       // no part was left out

  [[nodiscard]] Trees trees() const;  // must not outlive this
};

// Adds the texts to `sources`, which must outlive the result.
[[nodiscard]] Reading read_all(Input program, Input configuration, const ModuleReader& read_module,
                               const AlgorithmModules& algorithms, SourceMap& sources,
                               Diagnostics& diagnostics);

}  // namespace robosync::compiler
