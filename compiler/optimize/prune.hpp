// Leaves out what never runs, and what is constant as far as facts say. Facts must be filled in;
// those of new parts are not.
#pragma once

#include "compiler/ir/program.hpp"

namespace robosync::compiler {

void prune(ir::Program& program);

}  // namespace robosync::compiler
