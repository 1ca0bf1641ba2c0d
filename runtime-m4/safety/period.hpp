// How often the safety thread looks when nothing calls it: at the rules, and at the program's life.
// The periods are those of program time.
#pragma once

#include "runtime-m4/kernel/time.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::safety {

inline constexpr kernel::Duration kPeriod = kernel::milliseconds(policy::kSafetyPeriodMs);

// … and when no program runs: then there is nothing but the watchdog to look after, whose first
// time-out comes after 50 ms.
inline constexpr std::uint32_t kIdlePeriodMs = 30;
inline constexpr kernel::Duration kIdlePeriod = kernel::milliseconds(kIdlePeriodMs);

}  // namespace robosync::safety
