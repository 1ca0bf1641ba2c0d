#include "compiler/optimize/simplify.hpp"

#include <utility>

#include "compiler/ir/expression.hpp"
#include "vm/arithmetic.hpp"

namespace robosync::compiler {
namespace {

bool is_constant(const Expression& expression) {
  return expression.operation == Operation::constant;
}

bool is_constant(const Expression& expression, vm::Value value) {
  return is_constant(expression) && expression.constant == value;
}

Expression constant(vm::Value value) {
  Expression expression;
  expression.constant = value;
  return expression;
}

void become_operand(Expression& expression, std::size_t place) {
  Expression operand = std::move(expression.operands[place]);
  expression = std::move(operand);
}

Operation inverted(Operation comparison) {
  switch (comparison) {
    case Operation::less:
      return Operation::greater_equal;
    case Operation::less_equal:
      return Operation::greater;
    case Operation::greater:
      return Operation::less_equal;
    case Operation::greater_equal:
      return Operation::less;
    case Operation::equal:
      return Operation::not_equal;
    default:
      return Operation::equal;
  }
}

// ---- with one operand

void simplify_not(Expression& expression) {
  Expression& operand = expression.operands[0];
  if (is_constant(operand)) {
    expression = constant(vm::logical_not(operand.constant));
  } else if (operand.operation == Operation::logical_not) {
    become_operand(expression, 0);
    become_operand(expression, 0);
  } else if (is_comparison(operand.operation)) {
    operand.operation = inverted(operand.operation);
    become_operand(expression, 0);
  }
}

void simplify_negate(Expression& expression) {
  Expression& operand = expression.operands[0];
  if (is_constant(operand)) {
    expression = constant(vm::negate(operand.constant));
  } else if (operand.operation == Operation::negate) {
    become_operand(expression, 0);
    become_operand(expression, 0);
  }
}

// ---- with two operands

// x + 0, x - 0, x * 1, x / 1, x AND TRUE, x OR FALSE: these also hold if x is unknown.
bool changes_nothing(Operation operation, const Expression& right) {
  switch (operation) {
    case Operation::add:
    case Operation::subtract:
      return is_constant(right, 0);
    case Operation::multiply:
    case Operation::divide:
      return is_constant(right, vm::kScale);
    case Operation::logical_and:
      return is_constant(right, vm::kTrue);
    case Operation::logical_or:
      return is_constant(right, vm::kFalse);
    default:
      return false;
  }
}

bool is_symmetric(Operation operation) {
  return operation == Operation::add || operation == Operation::multiply ||
         operation == Operation::logical_and || operation == Operation::logical_or;
}

bool divides_by_zero(const Expression& expression) {
  return (expression.operation == Operation::divide || expression.operation == Operation::modulo) &&
         is_constant(expression.operands[1], 0);
}

// Puts constants on the right if the operands can be exchanged.
void order_operands(Expression& expression) {
  auto& operands = expression.operands;
  if (!is_constant(operands[0]) || is_constant(operands[1])) return;
  const bool comparison = is_comparison(expression.operation);
  if (!comparison && !is_symmetric(expression.operation)) return;
  std::swap(operands[0], operands[1]);
  if (comparison) expression.operation = mirrored(expression.operation);
}

// ---- comparisons of a computed number with a constant

// For a computation with a constant whose result only rises or only falls with the other operand: the index of that operand, 0 or
// 1. Otherwise 2.
std::size_t monotonous_operand(const Expression& expression) {
  const auto& operands = expression.operands;
  switch (expression.operation) {
    case Operation::negate:
      return 0;
    case Operation::subtract:
      if (is_constant(operands[0])) return 1;
      return is_constant(operands[1]) ? 0 : 2;
    case Operation::add:
    case Operation::multiply:
    case Operation::divide:
      return is_constant(operands[1]) && operands[1].constant != 0 ? 0 : 2;
    default:
      return 2;
  }
}

vm::Value computed(const Expression& expression, std::size_t place, vm::Value value) {
  if (expression.operation == Operation::negate) return vm::negate(value);
  const vm::Value other = expression.operands[1 - place].constant;
  return place == 0 ? compute(expression.operation, value, other)
                    : compute(expression.operation, other, value);
}

// x / 8 < 50 becomes x < 399.996. Finds the value where the truth changes with the robot's own arithmetic.
void compare_operand(Expression& comparison) {
  Expression& left = comparison.operands[0];
  const std::size_t place = monotonous_operand(left);
  if (place > 1) return;
  const vm::Value right = comparison.operands[1].constant;
  const auto holds = [&](std::int64_t value) {
    const vm::Value result = computed(left, place, static_cast<vm::Value>(value));
    return compute(comparison.operation, result, right) == vm::kTrue;
  };
  std::int64_t low = vm::kValueMin, high = vm::kValueMax;
  const bool at_low = holds(low);
  if (at_low == holds(high)) {  // always, or never
    comparison.operation = at_low ? Operation::greater_equal : Operation::less;
    comparison.operands[1].constant = vm::kValueMin;
  } else {
    while (high - low > 1) {  // holds(low) == at_low, and holds(high) is not
      const std::int64_t middle = (low + high) / 2;
      (holds(middle) == at_low ? low : high) = middle;
    }
    comparison.operation = at_low ? Operation::less : Operation::greater;
    comparison.operands[1].constant = static_cast<vm::Value>(at_low ? high : low);
  }
  become_operand(left, place);
}

void simplify_comparison(Expression& expression) {
  const Operation operation = expression.operation;
  if (operation == Operation::equal || operation == Operation::not_equal) return;
  while (is_constant(expression.operands[1]) && monotonous_operand(expression.operands[0]) < 2)
    compare_operand(expression);
}

void simplify_binary(Expression& expression) {
  auto& operands = expression.operands;
  order_operands(expression);
  const Operation operation = expression.operation;
  if (is_constant(operands[0]) && is_constant(operands[1])) {
    if (operation != Operation::random && !divides_by_zero(expression))
      expression = constant(compute(operation, operands[0].constant, operands[1].constant));
    return;
  }
  if (changes_nothing(operation, operands[1])) return become_operand(expression, 0);
  const bool always = (operation == Operation::logical_and && is_constant(operands[1], 0)) ||
                      (operation == Operation::logical_or && is_constant(operands[1], vm::kTrue));
  if (always && is_pure(operands[0])) return become_operand(expression, 1);
  if (is_comparison(operation)) simplify_comparison(expression);
}

}  // namespace

void simplify(Expression& expression) {
  if (is_time_word(expression.operation)) return;
  for (Expression& operand : expression.operands)
    simplify(operand);
  switch (expression.operation) {
    case Operation::logical_not:
      return simplify_not(expression);
    case Operation::negate:
      return simplify_negate(expression);
    case Operation::absolute:
      if (is_constant(expression.operands[0]))
        expression = constant(vm::absolute(expression.operands[0].constant));
      return;
    default:
      break;
  }
  if (expression.operands.size() == 2) simplify_binary(expression);
}

Expression negated(Expression condition) {
  Expression result;
  result.operation = Operation::logical_not;
  result.operands.push_back(std::move(condition));
  simplify(result);
  return result;
}

}  // namespace robosync::compiler
