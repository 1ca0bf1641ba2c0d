// Semantic analysis: takes the trees and the robot, returns a resolved program.
#pragma once

#include "compiler/ir/program.hpp"
#include "compiler/sema/names.hpp"

namespace robosync::compiler {

// The result is fit for codegen only if `diagnostics` has no errors afterwards. TEST blocks are
// left out: they are not for the robot.
[[nodiscard]] ir::Program analyze(const Trees& trees, const Robot& robot, const SourceMap& sources,
                                  Diagnostics& diagnostics);

}  // namespace robosync::compiler
