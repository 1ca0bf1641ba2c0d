// The board that rsc was built for, as far as programs are judged by it.
#pragma once

#include "runtime-m4/policy/costs.hpp"

namespace robosync::tool {

[[nodiscard]] const policy::BoardCosts& board_costs();

}  // namespace robosync::tool
