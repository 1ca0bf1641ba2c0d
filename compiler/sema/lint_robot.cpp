// W0208, W0209, W0218: the program against the robot it is for.
#include <algorithm>

#include "compiler/ir/walk.hpp"
#include "compiler/sema/lints.hpp"

namespace robosync::compiler {
namespace {

bool is_order(Operation operation) {
  return operation >= Operation::less && operation <= Operation::greater_equal;
}

// What is measured in a real unit trembles; "change" in robot.json holds small steps back.
bool is_noisy(const ChannelConfig& channel) {
  return channel.unit->dimension != vm::Dimension::number && channel.change == 0;
}

// The first reading of a noisy sensor that is compared as it is.
const Expression* raw_threshold(const Expression& condition, const Names& names) {
  if (condition.operation == Operation::latch || condition.operation == Operation::held)
    return nullptr;
  if (is_order(condition.operation)) {
    const bool fixed =
        std::any_of(condition.operands.begin(), condition.operands.end(),
                    [](const Expression& side) { return side.operation == Operation::constant; });
    for (const Expression& side : condition.operands)
      if (fixed && side.operation == Operation::input && is_noisy(names.channel(side.channel)))
        return &side;
    return nullptr;
  }
  for (const Expression& operand : condition.operands)
    if (const Expression* found = raw_threshold(operand, names)) return found;
  return nullptr;
}

void lint_noise(const LintInput& input) {
  for (const ProgramBehavior& behavior : input.program.behaviors) {
    for (const ProgramRule& rule : behavior.rules) {
      if (rule.kind == vm::RuleKind::every || rule.kind == vm::RuleKind::start) continue;
      const Expression* reading = raw_threshold(rule.condition, input.names);
      if (reading == nullptr) continue;
      const std::string name = input.names.channel_name(reading->channel);
      input.diagnostics
          .report(Code::W0208, "`" + name + "` may tremble about this number, and the rule with it")
          .label(rule.span)
          .helps("give the rule a MARGIN, or make a CHECK with SMOOTH of `" + name + "`");
    }
  }
}

// A few rules without a BEHAVIOR are a first try, which needs no sermon.
void lint_safety(const LintInput& input) {
  const Program& program = input.program;
  if (!program.safety.empty() || !program.speed_limits.empty()) return;
  const auto moves = [](const ProgramCommand& command) {
    return command.verb.action == vm::Action::move;
  };
  for (const ProgramBehavior& behavior : program.behaviors) {
    for (const ProgramRule& rule : behavior.rules) {
      const bool found = !behavior.name.empty() && (any_command(rule.then_response, moves) ||
                                                    any_command(rule.else_response, moves));
      if (!found) continue;
      input.diagnostics.report(Code::W0209, "this robot moves, and no SAFETY rule can stop it")
          .label(rule.span, "the first rule that moves it")
          .helps("write a SAFETY rule, or a LIMIT for its speed");
      return;
    }
  }
}

}  // namespace

void lint_robot(const LintInput& input) {
  if (input.program.behaviors.empty() && input.program.safety.empty())
    input.diagnostics.report(Code::W0218, "there is no rule: the robot does nothing").label({});
  lint_noise(input);
  lint_safety(input);
}

}  // namespace robosync::compiler
