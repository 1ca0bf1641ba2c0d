#include "compiler/sema/implication.hpp"

#include <algorithm>

namespace robosync::compiler {
namespace {

// A comparison of something with a constant, as the range of values for which it is true.
struct Threshold {
  const Expression* side = nullptr;
  std::int64_t low = vm::kValueMin, high = vm::kValueMax;
};

std::optional<Threshold> threshold(const Expression& condition) {
  if (condition.operands.size() != 2 || condition.operands[1].operation != Operation::constant)
    return std::nullopt;
  Threshold result{&condition.operands[0]};
  const std::int64_t number = condition.operands[1].constant;
  switch (condition.operation) {
    case Operation::less:
      result.high = number - 1;
      return result;
    case Operation::less_equal:
      result.high = number;
      return result;
    case Operation::greater:
      result.low = number + 1;
      return result;
    case Operation::greater_equal:
      result.low = number;
      return result;
    case Operation::equal:
      result.low = number;
      result.high = number;
      return result;
    default:
      return std::nullopt;
  }
}

// Drawn anew each time, it is not even equal to itself.
bool draws(const Expression& expression) {
  return expression.operation == Operation::random ||
         std::any_of(expression.operands.begin(), expression.operands.end(), draws);
}

}  // namespace

bool implies(const Expression& condition, const Expression& consequence) {
  if (draws(condition)) return false;
  if (condition == consequence) return true;
  const auto each = [&](const Expression& part) { return implies(part, consequence); };
  if (condition.operation == Operation::logical_and)
    return std::any_of(condition.operands.begin(), condition.operands.end(), each);
  // A condition that has held for some time holds now.
  if (condition.operation == Operation::held) return each(condition.operands[0]);
  const auto narrow = threshold(condition);
  const auto wide = threshold(consequence);
  return narrow && wide && *narrow->side == *wide->side && narrow->low >= wide->low &&
         narrow->high <= wide->high;
}

}  // namespace robosync::compiler
