// The costs that the boards declare, for tests on the host, which has its own.
#pragma once

#include "runtime-m4/policy/costs.hpp"

namespace robosync::tests {

#define COST(name, value, note) .name = (value),
inline constexpr policy::BoardCosts kMicrobitCosts = {
#include "runtime-m4/boards/microbit-v2/costs.def"
};
inline constexpr policy::BoardCosts kL475Costs = {
#include "runtime-m4/boards/b-l475e-iot01a/costs.def"
};
#undef COST

}  // namespace robosync::tests
