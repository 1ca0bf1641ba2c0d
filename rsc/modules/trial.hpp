// A module in a file held against its own declaration, and against robosync_module.h.
#pragma once

#include <string>
#include <vector>

#include "runtime-m4/module_files/desk.hpp"

namespace robosync::tool {

struct Finding {
  std::string promise;  // "it comes to the same every time"
  std::string broken;   // how; empty: it is kept
};

// What a module was tried with: parameters, and sample after sample.
struct Try {
  module_files::Config config{};
  std::uint32_t period_ms = 0;
  std::vector<module_files::Inputs> samples;
};

// Usual parameters and those at the ends of their ranges, the shortest, usual and longest period, inputs that hardly move, that
// jump, and the largest there are. The same for the same module.
[[nodiscard]] std::vector<Try> tries_for(const robosync_description& module);

// Up to the first promise that is broken in a way that ends the module.
[[nodiscard]] std::vector<Finding> try_module(const std::string& file);

}  // namespace robosync::tool
