// Numbers that are worked out twice in a response, from the same cells with nothing written in
// between, are worked out once, into a local.
#pragma once

#include "compiler/optimize/room.hpp"

namespace robosync::compiler {

// As far as there is room for the locals.
void share_numbers(ir::Program& program, const Room& room);

}  // namespace robosync::compiler
