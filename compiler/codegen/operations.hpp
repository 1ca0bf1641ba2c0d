// Maps operations of the program to opcodes.
#pragma once

#include <optional>

#include "compiler/ir/program.hpp"
#include "vm/opcode.hpp"

namespace robosync::compiler {

// A comparison whose right operand is a constant.
[[nodiscard]] vm::Opcode with_constant(Operation comparison);
// An operation on two cells. For greater and greater_equal use less and less_equal, mirrored.
[[nodiscard]] vm::Opcode with_cells(Operation operation);
// A jump unless the comparison with a constant, or with a cell, is true. For cells, see with_cells().
[[nodiscard]] vm::Opcode unless_with_constant(Operation comparison);
[[nodiscard]] vm::Opcode unless_with_cells(Operation comparison);
// The comparison that the jump includes.
[[nodiscard]] std::optional<vm::Opcode> compared_by(vm::Opcode jump);

// ---- cheaper instructions, if facts allow them

// An operation whose second operand is a constant.
struct WithConstant {
  vm::Opcode opcode{};
  vm::Value constant = 0;
};
[[nodiscard]] std::optional<WithConstant> constant_form(const Expression& expression);

// An operation without checks. `exchanged`: its operands are swapped.
struct Unchecked {
  vm::Opcode opcode{};
  bool exchanged = false;
};
[[nodiscard]] std::optional<Unchecked> unchecked_form(const Expression& expression);

}  // namespace robosync::compiler
