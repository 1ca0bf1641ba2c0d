// How many more frame cells the optimiser may use than the program as written, so that a program that fits the robot still fits
// when it is optimised.
#pragma once

#include <cstddef>
#include <vector>

#include "compiler/ir/program.hpp"

namespace robosync::compiler {

// An upper bound on the frame cells of a behaviour with these rules, as written: inputs and variables, the cells of statements
// (kCells), the truth values of time words, registers. Includes the registers for equal parts of conditions that are evaluated
// once.
[[nodiscard]] std::size_t cells_at_most(const std::vector<ir::Rule>& rules);

struct Room {
  bool in_registers = false;        // for equal parts of conditions
  std::vector<std::size_t> locals;  // for each behaviour: how many more its frame may have
};
[[nodiscard]] Room room_in(const ir::Program& program);

}  // namespace robosync::compiler
