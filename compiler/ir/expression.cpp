#include "compiler/ir/expression.hpp"

#include <algorithm>

namespace robosync::compiler {
namespace {

bool divides(const Expression& expression) {
  return expression.operation == Operation::divide || expression.operation == Operation::modulo;
}

}  // namespace

bool Expression::operator==(const Expression& other) const {
  return operation == other.operation && constant == other.constant && index == other.index &&
         channel == other.channel && operands == other.operands;
}

bool is_time_word(Operation operation) {
  return operation >= Operation::held && operation <= Operation::changed;
}

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

bool has_time_word(const Expression& expression) {
  return is_time_word(expression.operation) ||
         std::any_of(expression.operands.begin(), expression.operands.end(), has_time_word);
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
