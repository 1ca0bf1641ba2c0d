#include "compiler/ir/expression.hpp"

#include <algorithm>

#include "vm/arithmetic.hpp"

namespace robosync::compiler {
namespace {

bool divides(const Expression& expression) {
  return expression.operation == Operation::divide || expression.operation == Operation::modulo;
}

// A comparison of two known numbers.
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

bool Expression::operator==(const Expression& other) const {
  return operation == other.operation && constant == other.constant && index == other.index &&
         channel == other.channel && operands == other.operands;
}

bool is_time_word(Operation operation) {
  switch (operation) {
    case Operation::held:
    case Operation::counted:
    case Operation::sequence:
    case Operation::latch:
    case Operation::rose:
    case Operation::changed:
      return true;
    default:
      return false;
  }
}

bool is_comparison(Operation operation) {
  switch (operation) {
    case Operation::less:
    case Operation::less_equal:
    case Operation::greater:
    case Operation::greater_equal:
    case Operation::equal:
    case Operation::not_equal:
      return true;
    default:
      return false;
  }
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
    case Operation::minimum:
      return vm::lesser(left, right);
    case Operation::maximum:
      return vm::greater(left, right);
    case Operation::round:
      return vm::round_to(left, right);
    case Operation::logical_and:  // value.hpp: AND and OR of truth values are bitwise
      return left & right;
    case Operation::logical_or:
      return left | right;
    default:
      return relation(operation, left, right);
  }
}

bool has_time_word(const Expression& expression) {
  return is_time_word(expression.operation) ||
         std::any_of(expression.operands.begin(), expression.operands.end(), has_time_word);
}

bool reads_time(const Expression& expression) {
  const Operation operation = expression.operation;
  return operation == Operation::now || operation == Operation::elapsed ||
         operation == Operation::lasted ||
         std::any_of(expression.operands.begin(), expression.operands.end(), reads_time);
}

bool is_pure(const Expression& expression) {
  if (expression.operation == Operation::random || is_time_word(expression.operation)) return false;
  if (divides(expression)) {
    const Expression& divisor = expression.operands[1];
    if (divisor.operation != Operation::constant || divisor.constant == 0) return false;
  }
  return std::all_of(expression.operands.begin(), expression.operands.end(), is_pure);
}

}  // namespace robosync::compiler
