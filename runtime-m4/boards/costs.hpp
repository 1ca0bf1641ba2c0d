// The costs of the board that the preset names (ROBOSYNC_BOARD), as its costs.def declares them. The
// firmware and the tool both compile this, so neither can be built for a board that declares too little.
#pragma once

#include "runtime-m4/policy/costs.hpp"

namespace robosync::boards {

inline constexpr policy::BoardCosts kCosts = {
#define COST(name, value, note) .name = (value),
#include ROBOSYNC_BOARD_COSTS
#undef COST
};

}  // namespace robosync::boards
