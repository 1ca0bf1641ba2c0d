#include "rsc/board.hpp"

#include "runtime-m4/boards/costs.hpp"
#include "runtime-m4/boards/memory.hpp"

namespace robosync::tool {

const policy::BoardCosts& board_costs() {
  return boards::kCosts;
}

const policy::BoardMemory& board_memory() {
  return boards::kMemory;
}

}  // namespace robosync::tool
