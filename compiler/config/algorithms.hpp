// Entries of "algorithms" in robot.json.
#pragma once

#include "compiler/config/algorithm_modules.hpp"
#include "compiler/config/json_reader.hpp"
#include "compiler/config/robot.hpp"

namespace robosync::compiler {

// Appends the algorithm to the sensors of `robot`, which have all been read. Its outputs are the channels of the new sensor.
// Returns false if the entry cannot be used. `file`: the path of robot.json; paths of modules are relative to it.
bool read_algorithm(const json::Value& value, const std::string& file,
                    const AlgorithmModules& modules, Robot& robot, Diagnostics& diagnostics);

}  // namespace robosync::compiler
