// Removes code that never runs, and replaces expressions that facts prove constant. Facts must be filled in before; new parts
// have none.
#pragma once

#include "compiler/ir/program.hpp"

namespace robosync::compiler {

void prune(ir::Program& program);

}  // namespace robosync::compiler
