// Rewrites the program with fewer and cheaper instructions. Its behaviour stays the same in every step. docs/optimizer.md
// describes the facts and the rewrites.
#pragma once

#include "compiler/config/robot.hpp"
#include "compiler/ir/program.hpp"

namespace robosync::compiler {

// `program` as sema made it. The result has its facts filled in, and the same rules in the same order.
[[nodiscard]] ir::Program optimize(ir::Program program, const Robot& robot);

}  // namespace robosync::compiler
