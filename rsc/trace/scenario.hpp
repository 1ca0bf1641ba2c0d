// Scenarios: what the sensors measure, when (docs/link.md shows the format).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vm/image.hpp"

namespace robosync::tool {

struct Stimulus {
  std::uint64_t at_us = 0;
  std::uint8_t channel = 0;
  vm::Value value = 0;
};

struct Scenario {
  std::optional<std::uint64_t> duration_us;
  std::vector<Stimulus> stimuli;  // by time; ramps are resolved into single readings
};

// Throws Failure: outside when the file cannot be read; program when it is wrong, with file and
// line.
[[nodiscard]] Scenario read_scenario(const std::string& file, const vm::Image& image);

}  // namespace robosync::tool
