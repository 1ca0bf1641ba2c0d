// How often the safety thread looks when nothing calls it: at the rules, and at the program's life.
#pragma once

#include "runtime-m4/kernel/time.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::safety {

inline constexpr kernel::Duration kPeriod = kernel::milliseconds(policy::kSafetyPeriodMs);

}  // namespace robosync::safety
