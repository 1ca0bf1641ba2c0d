// How many cells of frames the optimiser may use more than the program as written does, so that
// what fits the robot still does when it is optimised.
#pragma once

#include <cstddef>
#include <vector>

#include "compiler/ir/program.hpp"

namespace robosync::compiler {

// The cells that the frame of a behaviour with these rules has at most, as they are written: what
// they read and set, what their statements keep (kCells), the truths of time words, registers.
// Counts the registers that conditions need when their equal parts are worked out once.
[[nodiscard]] std::size_t cells_at_most(const std::vector<ir::Rule>& rules);

struct Room {
  bool in_registers = false;        // for equal parts of conditions
  std::vector<std::size_t> locals;  // for each behaviour: how many more its frame may have
};
[[nodiscard]] Room room_in(const ir::Program& program);

}  // namespace robosync::compiler
