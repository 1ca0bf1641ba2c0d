// Which opcode an operation of the program becomes.
#pragma once

#include "compiler/sema/program.hpp"
#include "vm/opcode.hpp"

namespace robosync::compiler {

[[nodiscard]] bool is_comparison(Operation operation);
// The same comparison with its sides exchanged.
[[nodiscard]] Operation mirrored(Operation comparison);
// A comparison with a constant on its right side.
[[nodiscard]] vm::Opcode with_constant(Operation comparison);
// An operation with two cells. Not greater and greater_equal: they are less and less_equal
// mirrored.
[[nodiscard]] vm::Opcode with_cells(Operation operation);
[[nodiscard]] vm::Opcode of_time_word(Operation time_word);

}  // namespace robosync::compiler
