// Reads robot.json: the whole robot, with everything that is wrong reported.
#pragma once

#include "compiler/config/algorithm_modules.hpp"
#include "compiler/config/robot.hpp"

namespace robosync::compiler {

// Nothing only when the text is not JSON at all. Otherwise entries with mistakes stay in, with
// defaults in the place of what could not be read, so that the program's names still resolve.
[[nodiscard]] std::optional<Robot> read_robot(const SourceMap& sources, FileId file,
                                              Diagnostics& diagnostics,
                                              const AlgorithmModules& modules = {});

}  // namespace robosync::compiler
