// How often the safety thread looks when nothing calls it: at the rules, and at the program's life.
#pragma once

#include "runtime-m4/kernel/time.hpp"

namespace robosync::safety {

inline constexpr kernel::Duration kPeriod = kernel::milliseconds(10);

}  // namespace robosync::safety
