// Following a response, part: loops.
#include <algorithm>

#include "compiler/ir/walk.hpp"
#include "compiler/optimize/flow.hpp"

namespace robosync::compiler {
namespace {

// What a measured step depends on may itself grow in the loop: i, then i * i, then their sum.
constexpr unsigned kMeasurings = 3;

bool is_variable(const Expression& expression, std::size_t place) {
  return expression.operation == Operation::variable && expression.index == place;
}

// What `set` adds to its variable, if it does no more than that.
std::optional<Fact> step_of(const ProgramSet& set) {
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

void Flow::note_growth(const ProgramSet& set) {
  Growth& growth = (*growths_)[set.variable];
  const std::optional<Fact> step = step_of(set);
  growth.written = true;
  growth.regular = growth.regular && step && inner_loops_ == 0;
  if (!step) return;
  Fact once_at_most = either(*step, fact_of(0));
  once_at_most.known = true;  // what is unknown changes nothing
  growth.step = add(growth.step, once_at_most);
}

void Flow::forget_written(const ProgramBlock& body, State& state) const {
  for_each_of<ProgramSet>(
      body, [&](const ProgramSet& set) { state.variables[set.variable] = anytime_[set.variable]; });
}

void Flow::visit(ProgramRepeat& repeat, State& state) {
  repeat.assigned.clear();
  repeat.shifted.clear();
  if (repeat.kind == RepeatKind::times) look(repeat.control, state);
  const std::optional<vm::Value> times = constant_count(repeat);
  if (times && *times == 0) return;
  const bool rests = pauses(repeat.body);
  if (times && !rests) return counted(repeat, *times / vm::kScale, state);
  if (rests)
    begin_resting(state);
  else
    forget_written(repeat.body, state);
  if (repeat.kind == RepeatKind::while_) look(repeat.control, state);
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

// The body runs `times`, at least once, and never gives up the processor.
void Flow::counted(ProgramRepeat& repeat, vm::Value times, State& state) {
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

// What one round from `head` on does.
Flow::Growths Flow::measure(ProgramRepeat& repeat, State head) {
  Growths growths(program_.variables.size());
  const unsigned outer = inner_loops_;
  growths_ = &growths;
  inner_loops_ = 0;
  block(repeat.body, head);
  growths_ = nullptr;
  inner_loops_ = outer;
  return growths;
}

// The variables at the start of a round, after up to `times` others.
Flow::State Flow::grown(const ProgramRepeat& repeat, const State& before, const Growths& growths,
                        vm::Value times) const {
  State head = before;
  forget_written(repeat.body, head);
  for (std::size_t i = 0; i < growths.size(); ++i) {
    if (!growths[i].written || !growths[i].regular) continue;
    const ProgramVariable& variable = program_.variables[i];
    const Fact sum = add(before.variables[i], sum_of_up_to(times, growths[i].step));
    head.variables[i] = clamp(sum, variable.min, variable.max);
  }
  return head;
}

// Has variables written before the loop if a statement that runs in every round then can compute
// them in place. They are known: unlike a band, a variable that is set always is.
void Flow::claim(ProgramRepeat& repeat, State& head) {
  const auto owned_before = head.owned;
  const auto own = [](std::vector<Owned>& owned, const ProgramSet& set) {
    owned[set.variable] =
        std::max(owned[set.variable], set.relative ? Owned::shifted : Owned::assigned);
  };
  for (const ProgramStatement& statement : repeat.body)
    if (const auto* set = std::get_if<ProgramSet>(&statement.node)) own(head.owned, *set);
  measure(repeat, head);
  std::vector<Owned> wanted = owned_before;
  for (const ProgramStatement& statement : repeat.body) {
    const auto* set = std::get_if<ProgramSet>(&statement.node);
    if (set != nullptr && set->in_place) own(wanted, *set);
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] == owned_before[i]) continue;
    (wanted[i] == Owned::assigned ? repeat.assigned : repeat.shifted).push_back(i);
  }
  head.owned = std::move(wanted);
}

}  // namespace robosync::compiler
