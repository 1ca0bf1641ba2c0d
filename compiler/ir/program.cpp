#include "compiler/ir/program.hpp"

#include <algorithm>

#include "compiler/ir/walk.hpp"

namespace robosync::compiler::ir {

// A fraction counts as one more time, as on the robot.
std::optional<vm::Value> constant_count(const Repeat& repeat) {
  const bool counts = repeat.kind == RepeatKind::times;
  if (!counts || repeat.control.operation != Operation::constant) return std::nullopt;
  constexpr std::int64_t kMost = vm::kValueMax / vm::kScale;
  const std::int64_t times = (std::int64_t{repeat.control.constant} + vm::kScale - 1) / vm::kScale;
  return static_cast<vm::Value>(std::clamp<std::int64_t>(times, 0, kMost) * vm::kScale);
}

bool is_pause(const Statement& statement) {
  return std::visit([](const auto& node) { return node.kPauses; }, statement.node);
}

bool pauses(const Block& block) {
  bool found = false;
  for_each_statement(block,
                     [&](const Statement& statement) { found = found || is_pause(statement); });
  return found;
}

}  // namespace robosync::compiler::ir
