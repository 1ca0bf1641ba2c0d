// How often the safety thread looks when nothing calls it: at the rules, and at the program's life.
// The periods are those of program time.
#pragma once

#include <cstdint>

#include "runtime-m4/kernel/time.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::safety {

inline constexpr kernel::Duration kPeriod = kernel::milliseconds(policy::kSafetyPeriodMs);

// … and when no program runs: then there is nothing but the watchdog to look after. Its oscillator may be a tenth too fast.
constexpr kernel::Duration idle_period(std::uint32_t watchdog_ms) {
  return kernel::milliseconds(watchdog_ms * 3 / 5);
}

}  // namespace robosync::safety
