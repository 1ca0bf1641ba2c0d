// Which opcode an operation of the program becomes.
#pragma once

#include <optional>

#include "compiler/ir/program.hpp"
#include "vm/opcode.hpp"

namespace robosync::compiler {

// A comparison with a constant on its right side.
[[nodiscard]] vm::Opcode with_constant(Operation comparison);
// An operation with two cells. Not greater and greater_equal: they are less and less_equal
// mirrored.
[[nodiscard]] vm::Opcode with_cells(Operation operation);
// A jump unless the comparison with a constant, or with a cell, is true. Of cells as with_cells().
[[nodiscard]] vm::Opcode unless_with_constant(Operation comparison);
[[nodiscard]] vm::Opcode unless_with_cells(Operation comparison);
// The comparison that such a jump does.
[[nodiscard]] std::optional<vm::Opcode> compared_by(vm::Opcode jump);

// ---- cheaper instructions, where facts allow them

// An operation with a constant as its second operand.
struct WithConstant {
  vm::Opcode opcode{};
  vm::Value constant = 0;
};
[[nodiscard]] std::optional<WithConstant> constant_form(const Expression& expression);

// An operation that checks nothing. `exchanged`: its operands stand the other way round.
struct Unchecked {
  vm::Opcode opcode{};
  bool exchanged = false;
};
[[nodiscard]] std::optional<Unchecked> unchecked_form(const Expression& expression);

}  // namespace robosync::compiler
