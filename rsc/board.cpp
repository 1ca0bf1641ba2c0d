#include "rsc/board.hpp"

#include "runtime-m4/boards/costs.hpp"
#include "runtime-m4/boards/memory.hpp"

namespace robosync::tool {

const policy::BoardCosts& board_costs() {
  return boards::kCosts;
}

const policy::BoardCosts& costs_of(const compiler::Board& board) {
  for (const NamedCosts& named : all_board_costs())
    if (named.board == board.name) return named.costs;
  return board_costs();
}

const policy::BoardMemory& board_memory() {
  return boards::kMemory;
}

}  // namespace robosync::tool
