// The costs of the board that the preset names (ROBOSYNC_BOARD), as declared in its costs.def. The
// firmware and the tool both compile this, so neither can be built for a board with missing costs.
#pragma once

#include "runtime-m4/policy/costs.hpp"

namespace robosync::boards {

inline constexpr policy::BoardCosts kCosts = {
#define COST(name, value, note) .name = (value),
#include ROBOSYNC_BOARD_COSTS
#undef COST
};

}  // namespace robosync::boards
