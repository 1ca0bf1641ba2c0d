#include "compiler/sema/program.hpp"

#include <algorithm>

namespace robosync::compiler {

bool Expression::operator==(const Expression& other) const {
  return operation == other.operation && constant == other.constant && index == other.index &&
         channel == other.channel && operands == other.operands;
}

bool has_time_word(const Expression& expression) {
  return expression.operation >= Operation::held ||
         std::any_of(expression.operands.begin(), expression.operands.end(), has_time_word);
}

// A part of a time counts as a time, as it does where the robot works out the number.
std::optional<vm::Value> constant_count(const ProgramRepeat& repeat) {
  const bool counts = repeat.kind == RepeatKind::times;
  if (!counts || repeat.control.operation != Operation::constant) return std::nullopt;
  constexpr std::int64_t kMost = vm::kValueMax / vm::kScale;
  const std::int64_t times = (std::int64_t{repeat.control.constant} + vm::kScale - 1) / vm::kScale;
  return static_cast<vm::Value>(std::clamp<std::int64_t>(times, 0, kMost) * vm::kScale);
}

}  // namespace robosync::compiler
