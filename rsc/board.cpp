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

std::optional<compiler::Board> board_of(const vm::ImageHeader& header) {
  for (std::size_t i = 0; i < compiler::board_names().size(); ++i)
    if (compiler::board_id(compiler::board_names()[i]) == header.board)
      return compiler::board_at(i);
  return std::nullopt;
}

const policy::BoardMemory& board_memory() {
  return boards::kMemory;
}

}  // namespace robosync::tool
