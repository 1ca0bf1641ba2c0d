// Commands that the robot would lose: an actuator carries out one command at a time, and few may wait for it.
#pragma once

#include "compiler/sema/names.hpp"

namespace robosync::compiler {

// E0407: a response gives an actuator, or all of them, more commands in one step than can wait (vm::kMaxQueued,
// vm::max_queued()). THEN and every kind of WAIT are taken to end when all commands are done.
void check_waiting_commands(const ir::Program& program, const Names& names,
                            Diagnostics& diagnostics);

}  // namespace robosync::compiler
