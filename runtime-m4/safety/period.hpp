// How often the safety thread evaluates the rules and checks the program's liveness when nothing wakes
// it earlier. Periods are in program time.
#pragma once

#include <cstdint>

#include "runtime-m4/kernel/time.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::safety {

inline constexpr kernel::Duration kPeriod = kernel::milliseconds(policy::kSafetyPeriodMs);

// The period when no program runs: then the thread only kicks the watchdog, whose oscillator may be a tenth too fast.
constexpr kernel::Duration idle_period(std::uint32_t watchdog_ms) {
  return kernel::milliseconds(watchdog_ms * 3 / 5);
}

}  // namespace robosync::safety
