// Boards, as far as programs are judged by them: the one that robot.json names, or the image; where none is known, the one
// that rsc was built for.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "compiler/config/boards.hpp"
#include "runtime-m4/policy/costs.hpp"
#include "runtime-m4/policy/memory.hpp"
#include "vm/image.hpp"

namespace robosync::tool {

[[nodiscard]] const policy::BoardCosts& board_costs();

struct NamedCosts {
  std::string_view board;
  policy::BoardCosts costs;
};
[[nodiscard]] std::span<const NamedCosts> all_board_costs();  // as rsc/CMakeLists.txt writes them
[[nodiscard]] const policy::BoardCosts& costs_of(const compiler::Board& board);
[[nodiscard]] const policy::BoardMemory& board_memory();

// The one that an image is for; nothing when it is for none, or for one that this rsc does not know.
[[nodiscard]] std::optional<compiler::Board> board_of(const vm::ImageHeader& header);

// Of a board that robot.json names.
[[nodiscard]] inline policy::BoardMemory memory_of(const compiler::Board& board) {
  return {board.arena_begin, board.arena_bytes, board.step_budget};
}

}  // namespace robosync::tool
