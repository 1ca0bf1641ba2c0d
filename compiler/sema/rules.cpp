#include "compiler/sema/rules.hpp"

#include "compiler/sema/condition_lints.hpp"
#include "compiler/sema/lints.hpp"

namespace robosync::compiler {

ir::Rule Rules::translate(const ast::Rule& rule, bool inside) {
  ir::Rule result;
  result.line = statements_.line_of(rule.span);
  result.span = rule.head_span;
  modify(rule, inside, result);
  std::visit([&](const auto& node) { translate(rule, node, result); }, rule.node);
  return result;
}

void Rules::translate(const ast::Rule& rule, const ast::WhenRule& node, ir::Rule& result) {
  if (node.condition) {
    Typed condition = expressions_.condition(*node.condition, rule.modifiers.margin.get());
    if (node.else_block && condition.type == Type::condition &&
        !lint_sides(*node.condition, condition.code, diagnostics_))
      lint_start(rule, node, names_, condition, sources_, diagnostics_);
    result.condition = std::move(condition.code);
  }
  result.then_response = statements_.response(node.then_block);
  if (!node.else_block) return;
  result.kind = vm::RuleKind::when_else;
  result.else_response = statements_.response(*node.else_block);
}

void Rules::translate(const ast::Rule& rule, const ast::WhileRule& node, ir::Rule& result) {
  result.kind = vm::RuleKind::while_;
  if (node.condition) {
    result.condition = expressions_.condition(*node.condition, rule.modifiers.margin.get()).code;
    lint_while(rule, *node.condition, result.condition, diagnostics_);
  }
  result.then_response = statements_.response(node.body);
}

void Rules::translate(const ast::Rule&, const ast::EveryRule& node, ir::Rule& result) {
  result.kind = vm::RuleKind::every;
  result.condition = period(node);
  result.then_response = statements_.response(node.body);
}

// A fixed period, or one drawn anew each time.
Expression Rules::period(const ast::EveryRule& node) {
  if (!node.period) return {};
  Typed period = expressions_.duration(*node.period, "EVERY");
  if (!node.to) return std::move(period.code);
  Typed longest = expressions_.duration(*node.to, "TO");
  if (!period.is_number() || !longest.is_number()) return {};
  if (period.low > longest.high)
    diagnostics_.report(Code::E0509, "EVERY takes the shorter time first")
        .label(node.to->span)
        .label(node.period->span, "this is the longer one", false);
  return make_binary(Operation::random, std::move(period.code), std::move(longest.code));
}

void Rules::translate(const ast::Rule&, const ast::AtStartRule& node, ir::Rule& result) {
  result.kind = vm::RuleKind::start;
  result.then_response = statements_.response(node.body);
}

void Rules::refuse(Span span, std::string message, std::string help) {
  diagnostics_.report(Code::E0409, std::move(message)).label(span).helps(std::move(help));
}

void Rules::modify(const ast::Rule& rule, bool inside, ir::Rule& result) {
  const ast::Modifiers& modifiers = rule.modifiers;
  const bool is_while = std::holds_alternative<ast::WhileRule>(rule.node);
  const bool is_every = std::holds_alternative<ast::EveryRule>(rule.node);
  if (inside && modifiers.priority)
    refuse(modifiers.priority->span, "a rule in a BEHAVIOR has the priority of its BEHAVIOR",
           "remove it, or move the rule out of the BEHAVIOR");
  if (modifiers.cooldown)
    result.cooldown = expressions_.constant_duration(*modifiers.cooldown, "COOLDOWN").value_or(0);
  if (modifiers.waiting) {
    result.waiting = expressions_.constant_duration(*modifiers.waiting, "WAITING").value_or(0);
    if (is_while)
      refuse(modifiers.waiting->span, "a WHILE does not need WAITING",
             "it starts whenever its actuators are free and its condition holds");
  }
  if (modifiers.margin && is_every)
    refuse(modifiers.margin->span, "EVERY has no condition for a MARGIN", "remove it");
  result.restarting = modifiers.restarting;
  if (modifiers.restarting && is_while)
    refuse(rule.head_span, "a WHILE cannot be RESTARTING",
           "it runs as long as its condition holds");
  if (modifiers.restarting && is_every)
    refuse(rule.head_span, "EVERY cannot be RESTARTING",
           "a period that comes while the response runs is skipped");
}

ir::Rule Rules::translate(const ast::Safety& safety, Span span) {
  ir::Rule result;
  result.kind = vm::RuleKind::safety;
  result.line = statements_.line_of(span);
  result.span = safety.name.span;
  const ast::Modifiers& modifiers = safety.modifiers;
  const std::string always = "a SAFETY rule always comes first and acts immediately";
  if (modifiers.priority) refuse(modifiers.priority->span, "SAFETY has no PRIORITY", always);
  if (modifiers.cooldown) refuse(modifiers.cooldown->span, "SAFETY has no COOLDOWN", always);
  if (modifiers.waiting) refuse(modifiers.waiting->span, "SAFETY has no WAITING", always);
  if (modifiers.restarting)
    refuse(safety.name.span, "SAFETY cannot be RESTARTING",
           "it stays tripped until its RESUME WHEN");
  if (safety.condition)
    result.condition = expressions_.condition(*safety.condition, modifiers.margin.get()).code;
  result.then_response = statements_.safety(safety.body);
  if (!safety.resume) return result;
  Typed resume = expressions_.condition(*safety.resume);
  if (resume.type == Type::condition) result.resume = std::move(resume.code);
  return result;
}

}  // namespace robosync::compiler
