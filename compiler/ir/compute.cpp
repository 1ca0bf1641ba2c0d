#include "compiler/ir/compute.hpp"

#include "vm/arithmetic.hpp"

namespace robosync::compiler {
namespace {

// An operator on two known numbers that gives a truth.
vm::Value relation(Operation operation, vm::Value left, vm::Value right) {
  if (left == vm::kUnknown || right == vm::kUnknown) return vm::kUnknown;
  switch (operation) {
    case Operation::less:
      return vm::is_less(left, right);
    case Operation::less_equal:
      return vm::is_not_greater(left, right);
    case Operation::greater:
      return vm::is_greater(left, right);
    case Operation::greater_equal:
      return vm::is_not_less(left, right);
    case Operation::equal:
      return vm::is_equal(left, right);
    case Operation::not_equal:
      return vm::is_not_equal(left, right);
    default:
      return vm::kUnknown;
  }
}

}  // namespace

vm::Value compute(Operation operation, vm::Value left, vm::Value right) {
  switch (operation) {
    case Operation::add:
      return vm::add(left, right);
    case Operation::subtract:
      return vm::subtract(left, right);
    case Operation::multiply:
      return vm::multiply(left, right);
    case Operation::divide:
      return vm::divide(left, right);
    case Operation::modulo:
      return vm::modulo(left, right);
    case Operation::logical_and:  // value.hpp: the three-valued ones are bitwise
      return left & right;
    case Operation::logical_or:
      return left | right;
    default:
      return relation(operation, left, right);
  }
}

}  // namespace robosync::compiler
