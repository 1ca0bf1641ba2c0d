#include "rsc/board.hpp"

#include "runtime-m4/boards/costs.hpp"

namespace robosync::tool {

const policy::BoardCosts& board_costs() {
  return boards::kCosts;
}

}  // namespace robosync::tool
