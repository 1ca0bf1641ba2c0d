// The board that rsc was built for, as far as programs are judged by it.
#pragma once

#include "compiler/config/boards.hpp"
#include "runtime-m4/policy/costs.hpp"
#include "runtime-m4/policy/memory.hpp"

namespace robosync::tool {

[[nodiscard]] const policy::BoardCosts& board_costs();
[[nodiscard]] const policy::BoardMemory& board_memory();

// Of a board that robot.json names.
[[nodiscard]] inline policy::BoardMemory memory_of(const compiler::Board& board) {
  return {board.arena_begin, board.arena_bytes, board.step_budget};
}

}  // namespace robosync::tool
