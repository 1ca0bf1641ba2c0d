// Describes the algorithm modules of the firmware, and those in files, to the compiler and the analysis, which do not know the
// runtime.
#pragma once

#include <string>

#include "analysis/task_set.hpp"
#include "compiler/config/algorithm_modules.hpp"

namespace robosync::tool {

[[nodiscard]] compiler::AlgorithmModules algorithm_modules();

// An analysis::ModuleCost.
[[nodiscard]] analysis::Instructions module_cost(const vm::Image& image,
                                                 const vm::Sensor& algorithm);

// One line for each module in a file that failed after it was loaded; the robot went on without it.
[[nodiscard]] std::string module_troubles();

}  // namespace robosync::tool
