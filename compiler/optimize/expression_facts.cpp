#include "compiler/optimize/expression_facts.hpp"

namespace robosync::compiler {
namespace {

constexpr Fact kSomeTruth{false, false, vm::kTrue, vm::kFalse};

Fact fact_of_operation(Operation operation, const Fact& b, const Fact& c) {
  switch (operation) {
    case Operation::add:
      return add(b, c);
    case Operation::subtract:
      return subtract(b, c);
    case Operation::multiply:
      return multiply(b, c);
    case Operation::divide:
      return divide(b, c);
    case Operation::modulo:
      return modulo(b, c);
    case Operation::minimum:
      return minimum(b, c);
    case Operation::maximum:
      return maximum(b, c);
    case Operation::round:
      return round_to(b, c);
    case Operation::random:
      return random_between(b, c);
    case Operation::less:
      return is_less(b, c);
    case Operation::less_equal:
      return is_not_greater(b, c);
    case Operation::greater:
      return is_less(c, b);
    case Operation::greater_equal:
      return is_not_greater(c, b);
    case Operation::equal:
      return is_equal(b, c);
    case Operation::not_equal:
      return logical_not(is_equal(b, c));
    case Operation::logical_and:
      return logical_and(b, c);
    default:
      return logical_or(b, c);
  }
}

// Readings are clamped to the channel's range when they are published.
Fact fact_of_channel(const Robot& robot, ChannelRef ref) {
  const ChannelConfig& channel = robot.sensors[ref.sensor].channels[ref.channel];
  return {false, false, channel.min, channel.max};
}

Fact annotate_time_word(Expression& time_word, const Sight& sight) {
  const LocalFacts nothing;  // a local may not have its value yet
  const Sight any{sight.robot, sight.anytime, sight.anytime, nothing};
  for (Expression& operand : time_word.operands)
    annotate(operand, any);
  return kSomeTruth;
}

Fact work_out(Expression& expression, const Sight& sight) {
  auto& operands = expression.operands;
  switch (expression.operation) {
    case Operation::constant:
      return fact_of(expression.constant);
    case Operation::input:
      return fact_of_channel(sight.robot, expression.channel);
    case Operation::variable:
      return sight.now[expression.index];
    case Operation::local: {
      const auto local = sight.locals.find(expression.index);
      return local == sight.locals.end() ? Fact{} : local->second;
    }
    case Operation::now:
      return {true, false, vm::kValueMin, vm::kValueMax};
    case Operation::elapsed:
      annotate(operands[0], sight);
      return {true, false, 0, vm::kValueMax};
    case Operation::lasted:
      annotate(operands[0], sight);
      annotate(operands[1], sight);
      return kSomeTruth;
    case Operation::negate:
      return negate(annotate(operands[0], sight));
    case Operation::absolute:
      return absolute(annotate(operands[0], sight));
    case Operation::logical_not:
      return logical_not(annotate(operands[0], sight));
    default:
      break;
  }
  if (is_time_word(expression.operation)) return annotate_time_word(expression, sight);
  const Fact left = annotate(operands[0], sight);
  return fact_of_operation(expression.operation, left, annotate(operands[1], sight));
}

}  // namespace

Fact annotate(Expression& expression, const Sight& sight) {
  expression.fact = work_out(expression, sight);
  return expression.fact;
}

}  // namespace robosync::compiler
