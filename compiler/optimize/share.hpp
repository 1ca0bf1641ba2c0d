// Numbers that a response computes twice from the same cells, with no write in between, are computed once and kept in a local.
#pragma once

#include "compiler/optimize/room.hpp"

namespace robosync::compiler {

// Stops when there is no room for more locals.
void share_numbers(ir::Program& program, const Room& room);

}  // namespace robosync::compiler
