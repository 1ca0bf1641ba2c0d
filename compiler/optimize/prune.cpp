// An expression that draws a random number, remembers the past or may divide by zero stays. Without it the program would continue
// differently, or would not report the division by zero.
#include "compiler/optimize/prune.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "compiler/ir/walk.hpp"
#include "compiler/optimize/expression_facts.hpp"
#include "compiler/optimize/simplify.hpp"

namespace robosync::compiler {
namespace {

// True if a constant costs less than a cell as this operand.
bool takes_constant(Operation operation, std::size_t place, vm::Value value) {
  const bool whole = value % vm::kScale == 0;
  switch (operation) {
    case Operation::add:
      return true;
    case Operation::subtract:
      return place == 1;
    case Operation::multiply:
      return whole;
    case Operation::divide:
      return place == 1 && value > 0 && whole;
    case Operation::modulo:
      return place == 1 && value > 0;
    default:
      return is_comparison(operation);
  }
}

// Folds only operands that gain by it: a cell on its own is as cheap as a constant, and sometimes cheaper.
void fold_operands(Expression& expression) {
  if (is_time_word(expression.operation)) return;  // like simplify()
  for (std::size_t place = 0; place < expression.operands.size(); ++place) {
    Expression& operand = expression.operands[place];
    fold_operands(operand);
    const bool wanted =
        !operand.operands.empty() || takes_constant(expression.operation, place, operand.fact.low);
    if (operand.operation == Operation::constant || !wanted) continue;
    if (operand.fact.is_constant() && is_pure(operand)) {
      const Fact fact = operand.fact;
      operand = {};
      operand.constant = fact.low;
      operand.fact = fact;
    }
  }
}

void fold(Expression& expression) {
  fold_operands(expression);
  const bool computed = !expression.operands.empty();
  const Fact fact = expression.fact;
  if (computed && fact.is_constant() && is_pure(expression)) {
    expression = {};
    expression.constant = fact.low;
  }
  simplify(expression);
  expression.fact = fact;
}

// Time words in a response are evaluated in every step, whether or not the response runs, and the robot wakes up for them.
bool has_time_words(const ir::Block& block) {
  bool found = false;
  for_each_statement(block, [&](const ir::Statement& statement) {
    for_each_expression(statement, [&](const Expression& expression) {
      found = found || has_time_word(expression);
    });
  });
  return found;
}

// While a response runs, it owns every actuator that it has commands for, even in branches that do not run. The actuators that a
// behaviour commands also affect the rank of its thread.
bool has_effect(const ir::Block& block) {
  return has_time_words(block) || any_command(block, [](const ir::Command&) { return true; });
}

class Pruner {
public:
  void block(ir::Block& statements) {
    ir::Block result;
    for (ir::Statement& statement : statements)
      keep(std::move(statement), result);
    statements = std::move(result);
  }

private:
  void keep(ir::Statement statement, ir::Block& result);
  template <typename Node>
  void prune_parts(Node& node);
  void keep_claims(ir::Repeat& repeat);
  static void choose(ir::Statement statement, ir::Block& result);
};

template <typename Node>
void Pruner::prune_parts(Node& node) {
  for_each_part(
      node, [](Expression& expression) { fold(expression); },
      [this](ir::Block& inner) { block(inner); });
}

// A constant count of zero in the source gives a loop no code. If the count is only proved to be zero, the loop stays if its body
// has effects without running.
void Pruner::keep_claims(ir::Repeat& repeat) {
  const Expression control = repeat.control;
  prune_parts(repeat);
  if (constant_count(repeat) == 0 && has_effect(repeat.body)) repeat.control = control;
}

// Appends the statement with its parts pruned, or what is left of it.
void Pruner::keep(ir::Statement statement, ir::Block& result) {
  if (auto* const repeat = std::get_if<ir::Repeat>(&statement.node))
    keep_claims(*repeat);
  else
    prune_parts(statement);
  if (std::holds_alternative<ir::If>(statement.node))
    choose(std::move(statement), result);
  else
    result.push_back(std::move(statement));
}

// Also turns an IF with only an ELSE into one with only a THEN: if the condition is unknown, neither runs.
void Pruner::choose(ir::Statement statement, ir::Block& result) {
  auto& choice = std::get<ir::If>(statement.node);
  const Fact& condition = choice.condition.fact;
  if (is_pure(choice.condition)) {
    if (condition.never_true() && !has_effect(choice.then_block)) choice.then_block.clear();
    if (condition.high == vm::kTrue && !has_effect(choice.else_block)) choice.else_block.clear();
    if (choice.then_block.empty() && choice.else_block.empty()) return;
    const bool is_true = condition.low == vm::kTrue;
    const ir::Block& never = is_true ? choice.else_block : choice.then_block;
    if (condition.is_constant() && never.empty()) {
      ir::Block& always = is_true ? choice.then_block : choice.else_block;
      std::move(always.begin(), always.end(), std::back_inserter(result));
      return;
    }
  }
  if (choice.then_block.empty() && !choice.else_block.empty()) {
    const Fact inverse = logical_not(condition);
    choice.condition = negated(std::move(choice.condition));
    choice.condition.fact = inverse;
    choice.then_block = std::exchange(choice.else_block, {});
  }
  result.push_back(std::move(statement));
}

// A condition that is never true starts nothing. The rule stays, so that rules keep their numbers. In a rule with ELSE, false and
// unknown differ, so its condition is kept.
void prune(ir::Rule& rule) {
  fold(rule.condition);
  const bool only_when_true = rule.kind == vm::RuleKind::when || rule.kind == vm::RuleKind::while_;
  if (only_when_true && rule.condition.fact.never_true() && is_pure(rule.condition)) {
    rule.condition = {};
    rule.condition.constant = vm::kFalse;
    if (!has_effect(rule.then_response)) rule.then_response.clear();
  }
  Pruner().block(rule.then_response);
  Pruner().block(rule.else_response);
}

}  // namespace

// In SAFETY rules, only conditions are folded; the responses are not changed.
void prune(ir::Program& program) {
  for (ir::Rule& rule : program.safety)
    fold(rule.condition);
  for (ir::Behavior& behavior : program.behaviors)
    for (ir::Rule& rule : behavior.rules)
      prune(rule);
}

}  // namespace robosync::compiler
