// Scenarios: what the sensors measure, and when (docs/scenario.md; grammar/scenario.schema.json).
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
      notes;  // with file and line: readings that the program does not read, or out of range
};

// CSV files are looked up next to it. Throws Failure: outside if a file cannot be read; program,
// with file and line, if one is wrong.
[[nodiscard]] Scenario read_scenario(const std::string& file, const Program& program);

// Prints its notes on stderr.
void show_notes(const Scenario& scenario);

}  // namespace robosync::tool
