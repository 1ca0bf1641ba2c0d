#include "compiler/optimize/room.hpp"

#include <algorithm>
#include <set>

#include "compiler/ir/walk.hpp"
#include "vm/verifier.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kMostLocals = 32;           // extra locals for one behaviour
constexpr std::size_t kRegistersOfStatement = 2;  // in addition to those of its expressions

// One part keeps its value in a register while the part next to it is evaluated.
std::size_t registers_of(const Expression& expression) {
  if (expression.operation == Operation::input || expression.operation == Operation::variable ||
      expression.operation == Operation::local)
    return 0;
  std::size_t most = 0;
  for (const Expression& operand : expression.operands)
    most = std::max(most, registers_of(operand));
  return most + 1;
}

std::size_t operations_in(const Expression& expression) {
  std::size_t count = expression.operands.empty() ? 0 : 1;
  for (const Expression& operand : expression.operands)
    count += operations_in(operand);
  return count;
}

// Counts the cells for the frame of one behaviour.
class Count {
public:
  void add(const ir::Rule& rule) {
    add_condition(rule.condition);
    if (rule.resume) add_condition(*rule.resume);
    for_each_response(rule, [this](const ir::Block& block) {
      for_each_statement(block, [this](const ir::Statement& statement) { add(statement); });
    });
  }

  [[nodiscard]] std::size_t cells() const {
    return channels_.size() + variables_.size() + kept_ + truths_ + registers_;
  }

private:
  void add(const ir::Statement& statement) {
    kept_ += std::visit([](const auto& node) { return node.kCells; }, statement.node);
    if (const auto* set = std::get_if<ir::Set>(&statement.node)) variables_.insert(set->variable);
    for_each_expression(statement, [this](const Expression& expression) {
      registers_ = std::max(registers_, kRegistersOfStatement + registers_of(expression));
      add_inputs(expression);
      add_time_words(expression);
    });
    registers_ = std::max(registers_, kRegistersOfStatement);
  }

  // Each shared part occurs at least twice.
  void add_condition(const Expression& condition) {
    registers_ = std::max(registers_, registers_of(condition) + operations_in(condition) / 2);
    add_inputs(condition);
  }

  void add_inputs(const Expression& expression) {
    if (expression.operation == Operation::input) channels_.insert(expression.channel);
    if (expression.operation == Operation::variable) variables_.insert(expression.index);
    for (const Expression& operand : expression.operands)
      add_inputs(operand);
  }

  // In a response, each time word has its own watch rule, whose truth value needs a cell.
  void add_time_words(const Expression& expression) {
    if (is_time_word(expression.operation)) {
      ++truths_;
      return add_condition(expression);
    }
    for (const Expression& operand : expression.operands)
      add_time_words(operand);
  }

  std::set<ChannelRef> channels_;
  std::set<std::size_t> variables_;
  std::size_t kept_ = 0, truths_ = 0, registers_ = 0;
};

}  // namespace

std::size_t cells_at_most(const std::vector<ir::Rule>& rules) {
  Count count;
  for (const ir::Rule& rule : rules)
    count.add(rule);
  return count.cells();
}

Room room_in(const ir::Program& program) {
  constexpr std::size_t kAllCells = vm::Limits{}.frame_cells;
  std::vector<std::size_t> cells;
  std::size_t all = cells_at_most(program.safety);
  std::size_t most = all;
  for (const ir::Behavior& behavior : program.behaviors) {
    cells.push_back(cells_at_most(behavior.rules));
    all += cells.back();
    most = std::max(most, cells.back());
  }
  Room room{most <= vm::kMaxCells && all <= kAllCells, {}};
  for (const std::size_t own : cells) {
    const std::size_t left = std::min(kAllCells - std::min(all, kAllCells),
                                      vm::kMaxCells - std::min<std::size_t>(own, vm::kMaxCells));
    room.locals.push_back(std::min(left, kMostLocals));
    all += room.locals.back();
  }
  return room;
}

}  // namespace robosync::compiler
