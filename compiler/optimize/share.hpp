// Numbers that are worked out twice in a response, from the same cells with nothing written in
// between, are worked out once, into a local.
#pragma once

#include "compiler/sema/program.hpp"

namespace robosync::compiler {

void share_numbers(Program& program);

}  // namespace robosync::compiler
