// The numbers that the analysis uses: the declared costs, and what it assumes where a program does not
// say how often something happens (docs/timing.md).
#pragma once

#include "runtime-m4/policy/costs.hpp"

namespace robosync::analysis {

namespace costs = policy::costs;

inline constexpr std::uint32_t kFedPeriodMs = 100;   // of a sensor that is fed
inline constexpr std::uint32_t kTripPeriodMs = 100;  // of a SAFETY rule, without a reading

}  // namespace robosync::analysis
