// Collects the names that a program and its modules give.
#include <algorithm>

#include "compiler/sema/names.hpp"
#include "compiler/syntax/walk.hpp"

namespace robosync::compiler {

Names::Names(const Trees& trees, const Robot& robot, Diagnostics& diagnostics)
    : robot_(robot),
      diagnostics_(diagnostics),
      sensors_(index_of(robot.sensors)),
      actuators_(index_of(robot.actuators)),
      groups_(index_of(robot.groups)) {
  index_robot();
  for (const ast::Tree* tree : trees) {
    in_module_ = tree != trees.front();
    collect(*tree);
  }
  // A signal is declared by its use: what is declared in so many words comes first.
  for (const ast::Tree* tree : trees) {
    in_module_ = tree != trees.front();
    collect_signals(*tree);
  }
  for (const auto& [behavior, places] : private_)
    for (const auto& [folded, place] : places)
      if (const auto first = claimed_.find(folded); first != claimed_.end())
        report_twice(variables_[place].name, first->second);
}

void Names::collect(const ast::Tree& tree) {
  for (const ast::Item& item : tree.items)
    std::visit([this](const auto& node) { add(node); }, item.node);
}

void Names::report_twice(const ast::Name& name, Span first) {
  diagnostics_.report(Code::E0101, "the name `" + name.text + "` is given twice")
      .label(name.span)
      .label(first, "first given here", false);
}

// True if the name is new. An empty one was missing, which has been reported.
bool Names::claim(const ast::Name& name) {
  if (name.text.empty()) return false;
  const auto [first, added] = claimed_.emplace(fold_name(name.text), name.span);
  if (!added) report_twice(name, first->second);
  return added;
}

// As claim(), for a name that stands where a sensor's could.
bool Names::claim_operand(const ast::Name& name) {
  if (!claim(name)) return false;
  if (names_a_channel(name.text))
    diagnostics_.report(Code::E0101, "`" + name.text + "` is already a sensor of the robot")
        .label(name.span);
  return true;
}

void Names::add(const ast::Let& let) {
  if (claim_operand(let.name))
    constants_.emplace(fold_name(let.name.text), ConstantName{&let, in_module_});
}

void Names::add(const ast::Define& define) {
  check_parameters(define);
  if (!claim(define.name)) return;
  if (is_verb(define.name.text))
    diagnostics_.report(Code::E0101, "`" + define.name.text + "` is already a verb of the robot")
        .label(define.name.span);
  defines_.emplace(fold_name(define.name.text), DefineName{&define, define.name.span, in_module_});
}

void Names::check_parameters(const ast::Define& define) {
  std::map<std::string, Span> seen;
  for (const ast::Name& parameter : define.parameters) {
    const auto [first, added] = seen.emplace(fold_name(parameter.text), parameter.span);
    if (!added) report_twice(parameter, first->second);
  }
}

void Names::add(const ast::Behavior& behavior) {
  claim(behavior.name);
  Places& places = private_[&behavior];
  for (const ast::Remember& variable : behavior.variables) {
    if (variable.name.text.empty()) continue;
    const auto same = places.find(fold_name(variable.name.text));
    if (same != places.end()) {
      report_twice(variable.name, variables_[same->second].name.span);
      continue;
    }
    if (names_a_channel(variable.name.text))
      diagnostics_
          .report(Code::E0101, "`" + variable.name.text + "` is already a sensor of the robot")
          .label(variable.name.span);
    VariableName named{variable.name, 0, &variable, vm::VariableKind::plain, {}};
    add_variable(std::move(named), places);
  }
}

void Names::add_variable(VariableName variable, Places& places) {
  variable.index = variables_.size();
  variable.in_module = in_module_;
  places.emplace(fold_name(variable.name.text), variable.index);
  variables_.push_back(std::move(variable));
}

void Names::add(const ast::Remember& variable) {
  if (claim_operand(variable.name))
    add_variable({variable.name, 0, &variable, vm::VariableKind::plain, {}}, globals_);
}

void Names::add(const ast::State& state) {
  if (!claim_operand(state.name)) return;
  VariableName variable{state.name, 0, &state, vm::VariableKind::state, {}};
  for (const ast::Name& label : state.labels)
    variable.labels.push_back(label.text);
  add_variable(std::move(variable), globals_);
}

void Names::add(const ast::Feeling& feeling) {
  if (claim_operand(feeling.name))
    add_variable({feeling.name, 0, &feeling, vm::VariableKind::feeling, {}}, globals_);
}

void Names::add(const ast::Check& check) {
  if (!claim_operand(check.name)) return;
  VariableName variable{check.name, 0, &check, vm::VariableKind::band, {}};
  for (const ast::Band& band : check.bands)
    variable.labels.push_back(band.label.text);
  add_variable(std::move(variable), globals_);
}

// ---- signals

void Names::collect_signals(const ast::Tree& tree) {
  const auto add = [this](const ast::Block& block) { add_signals(block); };
  for (const ast::Item& item : tree.items) {
    if (const auto* define = std::get_if<ast::Define>(&item.node)) add(define->body);
    if (const auto* safety = std::get_if<ast::Safety>(&item.node)) add(safety->body);
    if (const auto* rule = std::get_if<ast::Rule>(&item.node)) for_each_block(*rule, add);
    if (const auto* behavior = std::get_if<ast::Behavior>(&item.node))
      for (const ast::Rule& rule : behavior->rules)
        for_each_block(rule, add);
  }
}

void Names::add_signals(const ast::Block& block) {
  for_each_statement(block, [this](const ast::Stmt& stmt) {
    if (const auto* signal = std::get_if<ast::Signal>(&stmt.node)) add_signal(signal->name);
  });
}

void Names::add_signal(const ast::Name& name) {
  const auto known = globals_.find(fold_name(name.text));
  const bool again =
      known != globals_.end() && variables_[known->second].kind == vm::VariableKind::signal;
  if (!again && claim_operand(name))
    add_variable({name, 0, {}, vm::VariableKind::signal, {}}, globals_);
}

}  // namespace robosync::compiler
