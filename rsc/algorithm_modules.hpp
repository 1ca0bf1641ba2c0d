// The algorithm modules of the firmware and those in files, as the compiler and the analysis want to know them: neither knows the runtime.
#pragma once

#include <string>

#include "analysis/task_set.hpp"
#include "compiler/config/algorithm_modules.hpp"

namespace robosync::tool {

[[nodiscard]] compiler::AlgorithmModules algorithm_modules();

// An analysis::ModuleCost.
[[nodiscard]] analysis::Instructions module_cost(const vm::Image& image,
                                                 const vm::Sensor& algorithm);

// What has happened to modules in files since they were loaded, a line each: they failed, and the robot went on without them.
[[nodiscard]] std::string module_troubles();

}  // namespace robosync::tool
