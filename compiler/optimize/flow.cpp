#include "compiler/optimize/flow.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "compiler/ir/walk.hpp"

namespace robosync::compiler {

WriteFacts Flow::follow(ir::Block& response, const VariableFacts& entry, bool in_place) {
  const std::size_t variables = program_.variables.size();
  locals_.clear();
  writes_ = {std::vector<std::optional<Fact>>(variables),
             std::vector<std::optional<Fact>>(variables)};
  in_place_ = in_place;
  note_sums(response);
  State state{entry, std::vector<Owned>(variables, Owned::no), std::vector<bool>(variables),
              std::vector<bool>(variables)};
  block(response, state);
  return std::move(writes_);
}

// A variable may be raised or lowered more than once in the same run. Then the sum may already have left its range, and no single
// statement bounds it. A statement in a loop counts twice.
void Flow::note_sums(const ir::Block& response) {
  std::vector<unsigned> count(program_.variables.size());
  const auto note = [&](const ir::Set& set) {
    if (set.relative) ++count[set.variable];
  };
  for_each_of<ir::Set>(response, note);
  for_each_of<ir::Repeat>(
      response, [&](const ir::Repeat& repeat) { for_each_of<ir::Set>(repeat.body, note); });
  sums_.assign(count.size(), false);
  for (std::size_t i = 0; i < count.size(); ++i) {
    const ir::Variable& variable = program_.variables[i];
    const bool bounded = variable.min > vm::kValueMin || variable.max < vm::kValueMax;
    sums_[i] = bounded && count[i] > 1;
  }
}

void Flow::block(ir::Block& statements, State& state) {
  for (ir::Statement& statement : statements)
    std::visit([&](auto& node) { visit(node, state); }, statement.node);
}

// For statements that hold no blocks and set nothing: annotates the expressions, then pauses if the statement does.
template <typename Node>
void Flow::visit(Node& node, State& state) {
  for_each_part(
      node, [&](Expression& expression) { look(expression, state); },
      [](auto& block) {
        static_assert(std::is_void_v<decltype(block)>, "when does its block run? say so below");
      });
  if (Node::kPauses) pause(state);
}

void Flow::visit(ir::Local& local, State& state) {
  const Fact value = look(local.value, state);
  locals_[local.number] = local.has_other_writers ? Fact{} : value;
}

// ---- writes

// SET to an unknown value does nothing.
void Flow::visit(ir::Set& set, State& state) {
  const ir::Variable& variable = program_.variables[set.variable];
  Fact& cell = state.variables[set.variable];
  const Fact value = look(set.value, state);
  Fact before = cell;
  if (set.relative && sums_[set.variable]) {
    before.low = vm::kValueMin;
    before.high = vm::kValueMax;
  }
  const Fact wanted = set.relative ? add(before, value) : value;
  const Fact result = clamp(wanted, variable.min, variable.max);
  Owned& owned = state.owned[set.variable];
  const Owned needed = set.relative ? Owned::shifted : Owned::assigned;
  set.before = before;
  set.may_be_below = wanted.low < variable.min;
  set.may_be_above = wanted.high > variable.max;
  set.in_place = in_place_ && wanted.known && owned >= needed && !state.barred[set.variable];
  state.held[set.variable] = true;
  if (growths_ != nullptr && dead_ == 0) note_growth(set);
  cell = wanted.known ? result : either(cell, result);
  cell.known = true;
  if (wanted.known) owned = std::max(owned, needed);
  if (growths_ == nullptr && dead_ == 0) record(set, cell);
}

void Flow::record(const ir::Set& set, const Fact& result) {
  const auto add_to = [](std::optional<Fact>& all, const Fact& one) {
    all = all ? either(*all, one) : one;
  };
  add_to(writes_.results[set.variable], result);
  if (set.relative) add_to(writes_.differences[set.variable], set.value.fact);
}

// ---- pauses

void Flow::pause(State& state) const {
  state.variables = anytime_;
  std::fill(state.owned.begin(), state.owned.end(), Owned::no);
  std::fill(state.held.begin(), state.held.end(), false);
  std::fill(state.barred.begin(), state.barred.end(), false);
}

void Flow::visit(ir::WaitUntil& wait, State& state) {
  if (wait.within) look(*wait.within, state);
  pause(state);
  look(wait.condition, state);
}

// The body runs repeatedly.
void Flow::visit(ir::Follow& follow, State& state) {
  if (follow.lasts) look(*follow.lasts, state);
  pause(state);
  block(follow.body, state);
}

// ---- choices

Flow::State Flow::merged(const State& one, const State& other) {
  State result = one;
  for (std::size_t i = 0; i < result.variables.size(); ++i) {
    result.variables[i] = either(one.variables[i], other.variables[i]);
    result.owned[i] = std::min(one.owned[i], other.owned[i]);
    result.held[i] = one.held[i] || other.held[i];
    result.barred[i] = one.barred[i] || other.barred[i];
  }
  return result;
}

void Flow::branch(ir::Block& statements, State& state, bool may_run) {
  if (!may_run) ++dead_;
  block(statements, state);
  if (!may_run) --dead_;
}

// The verifier reads code once, from start to end: a pause on one path also ends the response's ownership on the paths that come
// later in the code.
void Flow::pass(const ir::Block& before, State& state) {
  if (pauses(before)) std::fill(state.owned.begin(), state.owned.end(), Owned::no);
}

// Variables written in a block are owned until the block ends.
void Flow::visit(ir::If& choice, State& state) {
  const Fact condition = look(choice.condition, state);
  State then_state = state, else_state = state;
  const bool may_be_true = !condition.never_true();
  const bool may_be_false = condition.high == vm::kFalse;
  branch(choice.then_block, then_state, may_be_true);
  pass(choice.then_block, else_state);
  branch(choice.else_block, else_state, may_be_false);
  State after = may_be_true ? then_state : state;
  if (may_be_true && may_be_false) after = merged(then_state, else_state);
  if (!may_be_true && may_be_false) after = else_state;
  if (!condition.known) after = merged(after, state);
  for (std::size_t i = 0; i < state.owned.size(); ++i)
    after.owned[i] = std::min(after.owned[i], state.owned[i]);
  pass(choice.then_block, after);  // even if a side never runs: its code is still there
  pass(choice.else_block, after);
  state = std::move(after);
}

void Flow::visit(ir::Pick& pick, State& state) {
  if (pick.options.size() == 1) return block(pick.options.front().body, state);
  std::optional<State> after;
  for (ir::Option& option : pick.options) {
    State inner = state;
    block(option.body, inner);
    pass(option.body, state);
    after = after ? merged(*after, inner) : inner;
  }
  if (!after) return;
  after->owned = merged(*after, state).owned;
  state = std::move(*after);
}

// ---- loops

namespace {

// The amount that a round adds may itself grow in the loop: i, then i * i, then their sum.
constexpr unsigned kMeasurings = 3;

bool is_variable(const Expression& expression, std::size_t place) {
  return expression.operation == Operation::variable && expression.index == place;
}

// The amount that `set` adds to its variable; nullopt if it does anything else.
std::optional<Fact> step_of(const ir::Set& set) {
  if (set.relative) return set.value.fact;
  const auto& operands = set.value.operands;
  const Operation operation = set.value.operation;
  if (operation == Operation::add && is_variable(operands[0], set.variable))
    return operands[1].fact;
  if (operation == Operation::add && is_variable(operands[1], set.variable))
    return operands[0].fact;
  if (operation == Operation::subtract && is_variable(operands[0], set.variable))
    return negate(operands[1].fact);
  return std::nullopt;
}

}  // namespace

void Flow::note_growth(const ir::Set& set) {
  Growth& growth = (*growths_)[set.variable];
  const std::optional<Fact> step = step_of(set);
  growth.written = true;
  const bool sum = set.relative && sums_[set.variable];
  growth.regular = growth.regular && step && inner_loops_ == 0 && !sum;
  if (!step) return;
  Fact once_at_most = either(*step, fact_of(0));
  once_at_most.known = true;  // an unknown amount adds nothing
  growth.step = add(growth.step, once_at_most);
}

void Flow::forget_written(const ir::Block& body, State& state) const {
  for_each_of<ir::Set>(
      body, [&](const ir::Set& set) { state.variables[set.variable] = anytime_[set.variable]; });
}

void Flow::visit(ir::Repeat& repeat, State& state) {
  repeat.assigned.clear();
  repeat.shifted.clear();
  if (repeat.kind == ir::RepeatKind::times) look(repeat.control, state);
  const std::optional<vm::Value> times = constant_count(repeat);
  if (times && *times == 0) return;
  const bool rests = pauses(repeat.body);
  if (times && !rests) return counted(repeat, *times / vm::kScale, state);
  if (rests)
    begin_resting(state);
  else
    forget_written(repeat.body, state);
  if (repeat.kind == ir::RepeatKind::while_) look(repeat.control, state);
  State inner = state;
  ++inner_loops_;
  block(repeat.body, inner);
  --inner_loops_;
  state = times ? inner : merged(state, inner);
}

// In a loop that pauses, a round may begin in another step.
void Flow::begin_resting(State& state) const {
  std::vector<bool> barred = state.barred;
  for (std::size_t i = 0; i < barred.size(); ++i)
    barred[i] = barred[i] || state.held[i];
  pause(state);
  state.barred = std::move(barred);
}

// The body runs `times`, at least once, and never pauses.
void Flow::counted(ir::Repeat& repeat, vm::Value times, State& state) {
  State head = state;
  forget_written(repeat.body, head);
  if (growths_ == nullptr) {
    for (unsigned i = 0; i < kMeasurings; ++i)
      head = grown(repeat, state, measure(repeat, head), times - 1);
    if (in_place_ && times > 1) claim(repeat, head);
  }
  ++inner_loops_;
  block(repeat.body, head);
  --inner_loops_;
  state = std::move(head);
}

// Determines the effect of one round that starts in the state `head`.
Flow::Growths Flow::measure(ir::Repeat& repeat, State head) {
  Growths growths(program_.variables.size());
  const unsigned outer = inner_loops_;
  growths_ = &growths;
  inner_loops_ = 0;
  block(repeat.body, head);
  growths_ = nullptr;
  inner_loops_ = outer;
  return growths;
}

// The variables at the start of a round, after up to `times` earlier rounds.
Flow::State Flow::grown(const ir::Repeat& repeat, const State& before, const Growths& growths,
                        vm::Value times) const {
  State head = before;
  forget_written(repeat.body, head);
  for (std::size_t i = 0; i < growths.size(); ++i) {
    if (!growths[i].written || !growths[i].regular) continue;
    const ir::Variable& variable = program_.variables[i];
    const Fact sum = add(before.variables[i], sum_of_up_to(times, growths[i].step));
    head.variables[i] = clamp(sum, variable.min, variable.max);
  }
  return head;
}

// Writes variables before the loop if statements that run in every round can then compute them in place. Such a variable is
// known: unlike a band, a variable that is set always is.
void Flow::claim(ir::Repeat& repeat, State& head) {
  const auto owned_before = head.owned;
  const auto own = [](std::vector<Owned>& owned, const ir::Set& set) {
    owned[set.variable] =
        std::max(owned[set.variable], set.relative ? Owned::shifted : Owned::assigned);
  };
  for (const ir::Statement& statement : repeat.body)
    if (const auto* set = std::get_if<ir::Set>(&statement.node)) own(head.owned, *set);
  measure(repeat, head);
  std::vector<Owned> wanted = owned_before;
  for (const ir::Statement& statement : repeat.body) {
    const auto* set = std::get_if<ir::Set>(&statement.node);
    if (set != nullptr && set->in_place) own(wanted, *set);
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] == owned_before[i]) continue;
    (wanted[i] == Owned::assigned ? repeat.assigned : repeat.shifted).push_back(i);
  }
  head.owned = std::move(wanted);
}

}  // namespace robosync::compiler
