// Reads robot.json as a whole and reports everything that is wrong with it.
#pragma once

#include "compiler/config/algorithm_modules.hpp"
#include "compiler/config/robot.hpp"

namespace robosync::compiler {

// Returns nullopt only if the text is not JSON. Otherwise entries with mistakes stay in, with defaults for what could not be
// read, so that the program's names still resolve.
[[nodiscard]] std::optional<Robot> read_robot(const SourceMap& sources, FileId file,
                                              Diagnostics& diagnostics,
                                              const AlgorithmModules& modules = {});

}  // namespace robosync::compiler
