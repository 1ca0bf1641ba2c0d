#include "tests/oracles/rsl/evaluator.hpp"

#include <algorithm>

namespace robosync::oracle {
namespace {

using compiler::Expression;
using compiler::Operation;

bool is_event(Operation operation) {
  return operation == Operation::counted || operation == Operation::sequence ||
         operation == Operation::rose || operation == Operation::changed;
}

vm::TimerKind kind_of(Operation time_word) {
  switch (time_word) {
    case Operation::held:
      return vm::TimerKind::held;
    case Operation::counted:
      return vm::TimerKind::counted;
    case Operation::sequence:
      return vm::TimerKind::sequence;
    case Operation::latch:
      return vm::TimerKind::latch;
    case Operation::rose:
      return vm::TimerKind::rose;
    default:
      return vm::TimerKind::changed;
  }
}

TimeWord written(const Expression& expression) {
  return {kind_of(expression.operation), expression.constant, expression.index};
}

}  // namespace

// Operands from left to right, both of them always: RANDOM draws in that order.
Number Evaluator::number(const Expression& expression, const Sight& sight) {
  switch (expression.operation) {
    case Operation::constant:
      return number_of(expression.constant);
    case Operation::input: {
      const auto found = sight.snapshot.channels.find(expression.channel);
      return found == sight.snapshot.channels.end() ? std::nullopt : found->second;
    }
    case Operation::variable:
      if (sight.own != nullptr && sight.own->contains(expression.index))
        return sight.own->at(expression.index);
      return sight.snapshot.variables[expression.index];
    case Operation::local:
      return sight.locals->at(expression.index);
    case Operation::now:
      return sight.snapshot.now;
    case Operation::elapsed:  // "the time since its last RESTART"
      return sight.snapshot.now - number(expression.operands[0], sight).value_or(0);
    case Operation::negate:
      return negate(number(expression.operands[0], sight));
    case Operation::absolute:
      return absolute(number(expression.operands[0], sight));
    default:
      return arithmetic(expression, sight);
  }
}

Number Evaluator::arithmetic(const Expression& expression, const Sight& sight) {
  if (expression.operands.size() != 2)
    return std::nullopt;  // a truth: the compiler lets none stand here
  const Number left = number(expression.operands[0], sight);
  const Number right = number(expression.operands[1], sight);
  switch (expression.operation) {
    case Operation::add:
      return add(left, right);
    case Operation::subtract:
      return subtract(left, right);
    case Operation::multiply:
      return multiply(left, right);
    case Operation::divide:
      return divide(left, right);
    case Operation::modulo:
      return modulo(left, right);
    case Operation::minimum:
      return lesser(left, right);
    case Operation::maximum:
      return greater(left, right);
    case Operation::round:
      return to_multiple(left, right);
    case Operation::random:
      return sight.chance != nullptr ? sight.chance->draw(left, right) : left;
    default:
      return std::nullopt;  // a truth
  }
}

Truth Evaluator::truth(const Expression& expression, const Sight& sight) {
  if (is_time_word(expression.operation)) return words_[&expression].now;
  switch (expression.operation) {
    case Operation::logical_not:
      return opposite(truth(expression.operands[0], sight));
    case Operation::logical_and:
    case Operation::logical_or: {
      const Truth left = truth(expression.operands[0], sight);
      const Truth right = truth(expression.operands[1], sight);
      return expression.operation == Operation::logical_and ? both(left, right)
                                                            : either(left, right);
    }
    default:
      return comparison(expression, sight);
  }
}

Truth Evaluator::comparison(const Expression& expression, const Sight& sight) {
  if (expression.operands.size() != 2) {
    const Number value = number(expression, sight);
    return value ? Truth(*value != 0) : std::nullopt;
  }
  const Number left = number(expression.operands[0], sight);
  const Number right = number(expression.operands[1], sight);
  if (!left || !right) return std::nullopt;
  if (expression.operation == Operation::lasted) return sight.snapshot.now - *left >= *right;
  switch (expression.operation) {
    case Operation::less:
      return *left < *right;
    case Operation::less_equal:
      return *left <= *right;
    case Operation::greater:
      return *left > *right;
    case Operation::greater_equal:
      return *left >= *right;
    case Operation::equal:
      return *left == *right;
    default:
      return *left != *right;
  }
}

void Evaluator::remember(const Expression& expression, const Sight& sight, Moment now) {
  for (const Expression& operand : expression.operands)
    remember(operand, sight, now);
  if (!is_time_word(expression.operation)) return;
  Sample sample{now, {}, {}, {}};
  if (expression.operation == Operation::changed) {
    sample.number = number(expression.operands[0], sight);
  } else {
    sample.first = truth(expression.operands[0], sight);
    if (expression.operands.size() > 1) sample.second = truth(expression.operands[1], sight);
  }
  Word& word = words_[&expression];
  word.past.add(sample);
  word.now = word.past.truth(written(expression), now);
}

bool Evaluator::happens(const Expression& expression) const {
  if (is_event(expression.operation) && words_.at(&expression).now == true) return true;
  return std::any_of(expression.operands.begin(), expression.operands.end(),
                     [this](const Expression& operand) { return happens(operand); });
}

}  // namespace robosync::oracle
