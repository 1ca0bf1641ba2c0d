// Entries of "algorithms" in robot.json. What a module says of itself (runtime-m4/algorithms/) decides what may stand there.
#pragma once

#include "compiler/config/json_reader.hpp"
#include "compiler/config/robot.hpp"

namespace robosync::compiler {

// Adds the algorithm behind the sensors of `robot`, which have been read, as one more sensor: its outputs are that one's
// channels. False when there is an entry that cannot be used.
bool read_algorithm(const json::Value& value, Robot& robot, Diagnostics& diagnostics);

}  // namespace robosync::compiler
