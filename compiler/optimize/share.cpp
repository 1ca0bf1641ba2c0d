// For each statement, and from the outer parts of its expressions inwards: looks for the same part in the statement and in those
// that follow. The expressions at the beginning of a statement are always evaluated when it runs, so moving one to a local in
// front of it adds no cost.
#include "compiler/optimize/share.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "compiler/ir/walk.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kReach = 32;  // statements to look ahead in a block

using Visit = std::function<void(Expression&)>;

bool is_arithmetic(const Expression& expression) {
  switch (expression.operation) {
    case Operation::negate:
    case Operation::add:
    case Operation::subtract:
    case Operation::multiply:
    case Operation::divide:
    case Operation::modulo:
      return true;
    default:
      return false;
  }
}

bool reads(const Expression& expression, std::size_t variable) {
  if (expression.operation == Operation::variable) return expression.index == variable;
  return std::any_of(expression.operands.begin(), expression.operands.end(),
                     [&](const Expression& operand) { return reads(operand, variable); });
}

// True if it reads values that are latched again in each step.
bool reads_input(const Expression& expression) {
  if (expression.operation == Operation::variable || expression.operation == Operation::input ||
      reads_time(expression))
    return true;
  return std::any_of(expression.operands.begin(), expression.operands.end(), reads_input);
}

// True if a statement, or one inside it, changes the value of `expression`.
bool spoils(const ir::Statement& statement, const Expression& expression) {
  if (const auto* set = std::get_if<ir::Set>(&statement.node))
    return reads(expression, set->variable);
  bool found = is_pause(statement) && reads_input(expression);
  for_each_block(statement, [&](const ir::Block& block) {
    for (const ir::Statement& inner : block)
      found = found || spoils(inner, expression);
  });
  return found;
}

// The expressions that are evaluated when the statement begins, and only then.
void for_each_beginning(ir::Statement& statement, const Visit& visit) {
  if (std::holds_alternative<ir::WaitUntil>(statement.node)) return;
  const auto* repeat = std::get_if<ir::Repeat>(&statement.node);
  if (repeat != nullptr && repeat->kind == ir::RepeatKind::while_) return;
  for_each_expression(statement, visit);
}

// Replaces a number by a local wherever the number is computed again.
class Replacement {
public:
  Replacement(const Expression& number, std::size_t local) : number_(number) {
    local_.operation = Operation::local;
    local_.index = local;
    local_.fact = number.fact;
  }

  [[nodiscard]] unsigned found() const { return found_; }
  // Before this call, occurrences are only counted.
  void replace() { replaces_ = true; }

  void in(Expression& expression) {
    if (is_time_word(expression.operation)) return;  // evaluated in other steps, too
    if (expression == number_) {
      ++found_;
      if (replaces_) expression = local_;
      return;
    }
    for (Expression& operand : expression.operands)
      in(operand);
  }

  // Returns false if the number may have another value after the statement.
  bool in(ir::Statement& statement) {
    const bool spoilt = spoils(statement, number_);
    for_each_beginning(statement, [this](Expression& expression) { in(expression); });
    const bool again = std::holds_alternative<ir::Repeat>(statement.node) ||
                       std::holds_alternative<ir::Follow>(statement.node);
    if (!again || !spoilt) for_each_block(statement, [this](ir::Block& inner) { in(inner); });
    return !spoilt;
  }

private:
  void in(ir::Block& block) {
    for (ir::Statement& statement : block)
      if (!in(statement)) return;
  }

  Expression number_, local_;
  unsigned found_ = 0;
  bool replaces_ = false;
};

class Sharer {
public:
  // `left`: how many more locals may be added.
  Sharer(ir::Block& response, std::size_t& left) : left_(left) {
    for_each_of<ir::Local>(response, [this](const ir::Local& local) {
      next_local_ = std::max(next_local_, local.number + 1);
    });
    block(response);
  }

private:
  void block(ir::Block& statements);
  // Shares the first part of `expression` that occurs again in `statements` from `from` on.
  bool share_part(Expression& expression, ir::Block& statements, std::size_t from);
  static bool go_through(Replacement& replacement, ir::Block& statements, std::size_t from);

  std::size_t next_local_ = 0;
  std::size_t& left_;
};

void Sharer::block(ir::Block& statements) {
  for (std::size_t at = 0; at < statements.size(); ++at) {
    bool found = true;
    while (found && left_ > 0) {
      found = false;
      // A copy, because sharing a part inserts a statement in front of this one.
      std::vector<Expression> beginnings;
      for_each_beginning(statements[at],
                         [&](Expression& expression) { beginnings.push_back(expression); });
      for (Expression& expression : beginnings)
        found = found || share_part(expression, statements, at);
      if (found) ++at;
    }
    for_each_block(statements[at], [this](ir::Block& inner) { block(inner); });
  }
}

bool Sharer::share_part(Expression& expression, ir::Block& statements, std::size_t from) {
  if (is_time_word(expression.operation)) return false;
  if (is_arithmetic(expression) && is_pure(expression)) {
    Replacement replacement(expression, next_local_);
    go_through(replacement, statements, from);
    if (replacement.found() > 1) {
      replacement.replace();
      go_through(replacement, statements, from);
      const ir::Statement& first = statements[from];
      ir::Statement local{ir::Local{next_local_++, expression}, first.line, first.span};
      statements.insert(statements.begin() + static_cast<std::ptrdiff_t>(from), std::move(local));
      --left_;
      return true;
    }
  }
  return std::any_of(expression.operands.begin(), expression.operands.end(),
                     [&](Expression& part) { return share_part(part, statements, from); });
}

bool Sharer::go_through(Replacement& replacement, ir::Block& statements, std::size_t from) {
  const std::size_t end = std::min(statements.size(), from + kReach);
  for (std::size_t at = from; at < end; ++at)
    if (!replacement.in(statements[at])) return false;
  return true;
}

}  // namespace

void share_numbers(ir::Program& program, const Room& room) {
  for (std::size_t i = 0; i < program.behaviors.size(); ++i) {
    std::size_t left = room.locals[i];
    for (ir::Rule& rule : program.behaviors[i].rules)
      for_each_response(rule, [&](ir::Block& block) { Sharer(block, left); });
  }
}

}  // namespace robosync::compiler
