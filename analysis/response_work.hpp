// What one response (a DO or an ELSE) does, from its code: what its output costs, what it sets, how it
// waits. Images must be verified.
#pragma once

#include <bitset>
#include <cstdint>
#include <vector>

#include "analysis/pauses.hpp"
#include "analysis/response_time.hpp"
#include "vm/image.hpp"

namespace robosync::analysis {

using Inputs = std::bitset<std::size_t{2} * vm::kMaxInputs>;  // by number: channels, then variables

// What one response may do in one step, apart from running its code.
struct ResponseWork {
  Instructions other = 0;                 // everything but its commands
  std::vector<Instructions> by_actuator;  // its commands
  Inputs sets;
  Inputs later_sets;     // … after a pause
  bool follows = false;  // FOLLOW: may command whenever it checks
  bool polls = false;    // WAIT UNTIL: checks again whenever something changes
  Pauses pauses;
};

// `response`: its index, or vm::kNoIndex. `inputs`: what they may be, by number.
[[nodiscard]] ResponseWork work_of(const vm::Image& image, const vm::Behavior& behavior,
                                   std::uint16_t response, const Ranges& inputs);

}  // namespace robosync::analysis
