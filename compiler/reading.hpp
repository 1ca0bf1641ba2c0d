// A program, the modules that it uses and its robot.json, as they were read, before anything in them is resolved.
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
  std::optional<Robot> robot;  // nothing: nothing can be said of it
  bool complete = false;       // nothing had to be left out

  [[nodiscard]] Trees trees() const;  // which must not outlive this
};

// The texts go into `sources`, which must outlive the result.
[[nodiscard]] Reading read_all(Input program, Input configuration, const ModuleReader& read_module,
                               const AlgorithmModules& algorithms, SourceMap& sources,
                               Diagnostics& diagnostics);

}  // namespace robosync::compiler
