// Scenarios: what the sensors measure, when (docs/scenario.md; grammar/scenario.schema.json).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rsc/program.hpp"

namespace robosync::tool {

struct Stimulus {
  std::uint64_t at_us = 0;
  std::uint8_t channel = 0;
  vm::Value value = 0;
};

struct Scenario {
  std::optional<std::uint64_t> duration_us;
  std::vector<Stimulus> stimuli;  // by time; ramps are resolved into single readings
  std::vector<std::string>
      notes;  // with file and line: readings that nobody reads, or out of range
};

// CSV files that it names are found beside it. Throws Failure: outside when a file cannot be read;
// program when one is wrong, with file and line.
[[nodiscard]] Scenario read_scenario(const std::string& file, const Program& program);

// Its notes, for a person, on stderr.
void show_notes(const Scenario& scenario);

}  // namespace robosync::tool
