#include "tests/oracles/rsl/evaluator.hpp"

#include <algorithm>

namespace robosync::reference {
namespace {

using compiler::Expression;
using compiler::Operation;

bool is_time_word(Operation operation) {
  return operation >= Operation::held && operation <= Operation::changed;
}

bool is_event(Operation operation) {
  return operation == Operation::counted || operation == Operation::sequence ||
         operation == Operation::rose || operation == Operation::changed;
}

Number known(vm::Value value) {
  return value == vm::kUnknown ? std::nullopt : Number(value);
}

}  // namespace

Number Evaluator::number(const Expression& expression, const Sight& sight) {
  const auto part = [&](std::size_t i) { return number(expression.operands[i], sight); };
  switch (expression.operation) {
    case Operation::constant:
      return known(expression.constant);
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
    case Operation::negate:
      return negate(part(0));
    case Operation::add:
      return add(part(0), part(1));
    case Operation::subtract:
      return subtract(part(0), part(1));
    case Operation::multiply:
      return multiply(part(0), part(1));
    case Operation::divide:
      return divide(part(0), part(1));
    case Operation::modulo:
      return modulo(part(0), part(1));
    case Operation::random: {
      const Number low = part(0);
      const Number high = part(1);
      return sight.chance != nullptr ? sight.chance->draw(low, high) : low;
    }
    default:
      return std::nullopt;  // a truth: the compiler lets none stand here
  }
}

Truth Evaluator::truth(const Expression& expression, const Sight& sight) {
  const auto part = [&](std::size_t i) { return truth(expression.operands[i], sight); };
  if (is_time_word(expression.operation)) return words_[&expression].now;
  switch (expression.operation) {
    case Operation::logical_not:
      return opposite(part(0));
    case Operation::logical_and:
      return both(part(0), part(1));
    case Operation::logical_or:
      return either(part(0), part(1));
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
  word.now = word.past.truth(expression, now);
}

bool Evaluator::happens(const Expression& expression) const {
  if (is_event(expression.operation) && words_.at(&expression).now == true) return true;
  return std::any_of(expression.operands.begin(), expression.operands.end(),
                     [this](const Expression& operand) { return happens(operand); });
}

}  // namespace robosync::reference
