// Tests a module in a file against its declaration and against robosync_module.h.
#pragma once

#include <string>
#include <vector>

#include "runtime-m4/module_files/desk.hpp"

namespace robosync::tool {

struct Finding {
  std::string promise;  // "it gives the same outputs every time"
  std::string broken;   // how it is broken; empty: it holds
};

// The inputs of a test: parameters, and a series of samples.
struct Try {
  module_files::Config config{};
  std::uint32_t period_ms = 0;
  std::vector<module_files::Inputs> samples;
};

// Default parameters and both ends of their ranges; the shortest, the usual and the longest period; inputs that hardly change,
// that jump, and that are as large as possible. The same for the same module.
[[nodiscard]] std::vector<Try> tries_for(const robosync_description& module);

// Stops at the first broken promise that ends the module.
[[nodiscard]] std::vector<Finding> try_module(const std::string& file);

}  // namespace robosync::tool
