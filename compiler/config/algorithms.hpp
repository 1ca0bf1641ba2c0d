// Entries of "algorithms" in robot.json.
#pragma once

#include "compiler/config/algorithm_modules.hpp"
#include "compiler/config/json_reader.hpp"
#include "compiler/config/robot.hpp"

namespace robosync::compiler {

// Adds the algorithm behind the sensors of `robot`, which have been read, as one more sensor: its outputs are that one's
// channels. False when there is an entry that cannot be used. `file`: robot.json, beside which modules in files stand.
bool read_algorithm(const json::Value& value, const std::string& file,
                    const AlgorithmModules& modules, Robot& robot, Diagnostics& diagnostics);

}  // namespace robosync::compiler
