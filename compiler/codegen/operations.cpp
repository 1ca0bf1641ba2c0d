#include "compiler/codegen/operations.hpp"

namespace robosync::compiler {

bool is_comparison(Operation operation) {
  return operation >= Operation::less && operation <= Operation::not_equal;
}

Operation mirrored(Operation comparison) {
  switch (comparison) {
    case Operation::less:
      return Operation::greater;
    case Operation::less_equal:
      return Operation::greater_equal;
    case Operation::greater:
      return Operation::less;
    case Operation::greater_equal:
      return Operation::less_equal;
    default:
      return comparison;
  }
}

vm::Opcode with_constant(Operation comparison) {
  switch (comparison) {
    case Operation::less:
      return vm::Opcode::lt_k;
    case Operation::less_equal:
      return vm::Opcode::le_k;
    case Operation::greater:
      return vm::Opcode::gt_k;
    case Operation::greater_equal:
      return vm::Opcode::ge_k;
    case Operation::equal:
      return vm::Opcode::eq_k;
    default:
      return vm::Opcode::ne_k;
  }
}

vm::Opcode with_cells(Operation operation) {
  switch (operation) {
    case Operation::add:
      return vm::Opcode::add;
    case Operation::subtract:
      return vm::Opcode::sub;
    case Operation::multiply:
      return vm::Opcode::mul;
    case Operation::divide:
      return vm::Opcode::div;
    case Operation::modulo:
      return vm::Opcode::mod;
    case Operation::random:
      return vm::Opcode::random;
    case Operation::less:
      return vm::Opcode::lt;
    case Operation::less_equal:
      return vm::Opcode::le;
    case Operation::equal:
      return vm::Opcode::eq;
    case Operation::not_equal:
      return vm::Opcode::ne;
    case Operation::logical_and:
      return vm::Opcode::and_;
    default:
      return vm::Opcode::or_;
  }
}

vm::Opcode of_time_word(Operation time_word) {
  switch (time_word) {
    case Operation::held:
      return vm::Opcode::held;
    case Operation::counted:
      return vm::Opcode::counted;
    case Operation::sequence:
      return vm::Opcode::sequence;
    case Operation::latch:
      return vm::Opcode::latch;
    case Operation::rose:
      return vm::Opcode::rose;
    default:
      return vm::Opcode::changed;
  }
}

}  // namespace robosync::compiler
