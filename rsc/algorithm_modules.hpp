// The algorithm modules of the firmware, as the compiler and the analysis want to know them: neither knows the runtime.
#pragma once

#include "analysis/task_set.hpp"
#include "compiler/config/algorithm_modules.hpp"

namespace robosync::tool {

[[nodiscard]] compiler::AlgorithmModules algorithm_modules();

// An analysis::ModuleCost.
[[nodiscard]] analysis::Instructions module_cost(const vm::Image& image,
                                                 const vm::Sensor& algorithm);

}  // namespace robosync::tool
