// See behavior.hpp. May rely on the verifier for every index in the image; does not trust anything that
// the behaviours' threads leave in the workspace.
#include "runtime-m4/layers/behavior.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "runtime-m4/kernel/calls.hpp"
#include "runtime-m4/layers/clock.hpp"
#include "runtime-m4/layers/report.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::layers {

using link::EventKind;

bool BehaviorLayer::start(const LoadedProgram& program, Memory& memory, ProgramThreads& threads) {
  program_ = &program;
  snapshot_ = nullptr;
  is_released_ = false;
  retired_ = 0;
  units_ = memory.take_zero<policy::Part::behavior_units, Unit>();
  resume_points_ = memory.take<policy::Part::resume_points, ResumePoint>();
  polls_since_ = memory.take<policy::Part::polls_since, std::uint32_t>();
  for (unsigned b = program.first_behavior(); b < program.image.behaviors.size(); ++b)
    if (!start_unit(b, threads)) return false;
  return true;
}

bool BehaviorLayer::start_unit(unsigned behavior, ProgramThreads& threads) {
  Unit& unit = units_[behavior];
  unit.layer = this;
  unit.behavior = static_cast<std::uint8_t>(behavior);
  const vm::Behavior& wiring = program_->image.behaviors[behavior];
  kernel::ThreadSpec spec;
  spec.name = name_of(program_->image, wiring.name, "rule");
  spec.category = kernel::Category::behavior;
  spec.privileged = false;
  spec.entry = [](void* self) {
    auto& mine = *static_cast<Unit*>(self);
    mine.layer->run(mine);
  };
  spec.argument = &unit;
  unit.thread = threads.start(spec, behavior);
  return unit.thread != nullptr;
}

// --- called from the step thread ---

void BehaviorLayer::take_turn(unsigned behavior, const RuleSet& rules) {
  concerned_ = &rules;
  task_ = Task::turn;
  release(behavior);
}

void BehaviorLayer::take_sole_turn(unsigned rule, bool goes_on) {
  task_ = Task::sole_turn;
  goes_on_ = goes_on;
  rule_ = static_cast<std::uint16_t>(rule);
  release(program_->behavior_of[rule]);
}

void BehaviorLayer::respond(unsigned rule, Side side) {
  resume_points_[rule].pause = vm::Pause::ended;
  release_to_run(rule, begin_of(rule, side));
}

void BehaviorLayer::go_on(unsigned rule) {
  release_to_run(rule, resume_points_[rule].next);
}

void BehaviorLayer::release_to_run(unsigned rule, unsigned code) {
  task_ = Task::response;
  rule_ = static_cast<std::uint16_t>(rule);
  code_ = static_cast<std::uint16_t>(code);
  release(program_->behavior_of[rule]);
}

// A stopped behaviour is not released, so there is no result.
void BehaviorLayer::release(unsigned behavior) {
  workspace_.result->there = 0;
  if (is_retired(behavior)) return;
  released_ = static_cast<std::uint8_t>(behavior);
  is_released_ = true;
  workspace_.finished->store(false, std::memory_order_relaxed);
  kernel_.signal(*units_[behavior].thread, kReleased);
}

bool BehaviorLayer::busy() {
  if (workspace_.finished->load(std::memory_order_relaxed)) is_released_ = false;
  return is_released_;
}

bool BehaviorLayer::is_at_work() const {
  return is_released_ && kernel_.state(*units_[released_].thread) == kernel::Thread::State::ready;
}

// The call `rest` makes the step thread ready and blocks the behaviour, in one critical section.
kernel::Thread* BehaviorLayer::blocked_at_work(const kernel::Thread& step_thread) const {
  constexpr auto kBlocked = kernel::Thread::State::blocked;
  if (!is_released_ || kernel_.state(step_thread) != kBlocked) return nullptr;
  kernel::Thread* const thread = units_[released_].thread;
  return kernel_.state(*thread) == kBlocked ? thread : nullptr;
}

// The behaviour could say so of any of its own rules that does not cool down, just as it could let it trigger.
bool BehaviorLayer::sole_claim_of(RuleRange rules, Claim& claim) const {
  const unsigned rule = workspace_.result->rule;
  Side side{};
  return rule >= rules.first && rule < rules.end && has_begun(rule, side) &&
         claim_for(rule, side, !layers_.triggers.has_triggered(rule), claim);
}

// A response that waits must do so at a place in the code; and one that polls, in a program in which one does.
vm::Pause BehaviorLayer::checked_pause(const Result& result) const {
  if (result.pause == vm::Pause::ended || result.pause >= vm::Pause::count_)
    return vm::Pause::ended;
  const std::span<const vm::Word> code = program_->image.code;
  const bool inside = result.next >= code.data() && result.next < code.data() + code.size();
  const bool polls = result.pause != vm::Pause::until_time && result.pause != vm::Pause::until_done;
  return inside && !(polls && polls_since_.empty()) ? result.pause : vm::Pause::ended;
}

// When its response began, or went on and waited again; or was interrupted. While that is of no interest: long ago.
std::uint32_t BehaviorLayer::ran_at(unsigned rule) const {
  const ResumePoint& point = resume_points_[rule];
  switch (point.pause) {
    case vm::Pause::ended:
      return point.time;
    case vm::Pause::polling:
    case vm::Pause::still_polling:
      return polls_since_[rule];
    case vm::Pause::until_done:
    case vm::Pause::satisfied:
      return point.time - policy::kLeastPauseMs;
    default:
      return snapshot_->milliseconds() - policy::kLeastPauseMs;
  }
}

// ResumePoint::time after a run. Only a response that polls may have none. Whatever its thread says, no response goes on before
// the next millisecond, or the step thread would never rest.
std::uint32_t BehaviorLayer::time_of(unsigned rule, vm::Pause pause, bool has_waited) {
  const std::uint32_t now = snapshot_->milliseconds();
  std::uint32_t wake = workspace_.result->wake;
  if (wake != kNever && reached(wake, now)) [[unlikely]]
    wake = now + 1;
  switch (pause) {
    case vm::Pause::ended:
      return has_waited ? now - policy::kLeastPauseMs : now;
    case vm::Pause::until_done:
      return as_time(now + policy::kLeastPauseMs);
    case vm::Pause::satisfied:
      return as_time(now + std::max<std::uint32_t>(rest_left(rule, now), 1));
    case vm::Pause::still_polling:
      return wake;
    case vm::Pause::polling:
      polls_since_[rule] = now;
      [[fallthrough]];
    default:
      return as_time(wake);
  }
}

// A response whose behaviour was stopped meanwhile has no effect.
void BehaviorLayer::conclude(unsigned rule) {
  Result& result = *workspace_.result;
  const unsigned behavior = program_->behavior_of[rule];
  if (is_retired(behavior) || result.there == 0) result = {};
  result.there = 0;  // it is taken
  ResumePoint& point = resume_points_[rule];
  const vm::Pause pause = checked_pause(result);
  const bool waited = point.pause != vm::Pause::ended;
  const bool moved = pause != vm::Pause::still_polling && pause != vm::Pause::satisfied;
  Trace& trace = layers_.trace;
  if (waited && moved) trace.emit(EventKind::go_on, trace.step(), rule);
  if (result.zero_divide != 0) trace.emit(EventKind::zero_divide, trace.step(), rule);
  if (result.words != 0) put_out(layers_.arbiter.holding(rule).actuators);
  if ((result.assigned | result.shifted) != 0) stage_writes(behavior);
  point.time = time_of(rule, pause, waited);
  point.pause = pause;
  if (pause == vm::Pause::ended) return;
  point.next = static_cast<std::uint16_t>(result.next - program_->image.code.data());
  if (moved) trace.emit(EventKind::wait, trace.step(), rule);
}

void BehaviorLayer::stage_writes(unsigned behavior) {
  layers_.variables.stage({.frame = layers_.frames.frame(*program_, behavior),
                           .assigned = workspace_.result->assigned,
                           .shifted = workspace_.result->shifted},
                          program_->image.behaviors[behavior], *snapshot_);
}

// A command to a group goes to each member. A parameter that the program gives overrides its word's, which is always known.
[[gnu::always_inline]] inline void BehaviorLayer::stage(vm::Output said, ActuatorMask declared) {
  const vm::Image& image = program_->image;
  drivers::Order& order = command_.order_;
  if (said.verb >= image.verbs.size()) return;
  order.action = image.verbs[said.verb].action;
  order.given = said.given;
  command_.complete_ = order.is_known();
  if (said.word != vm::kNoWord) {
    if (said.word >= image.words.size()) return;
    const vm::WordEntry& word = image.words[said.word];
    if (!order.has(word.param)) order.give(word.param, word.value);
  }
  command_.verb_ = said.verb;
  command_.word_ = said.word;
  command_.given_ = said.given;
  layers_.control.stage(command_, image.target_mask(said.target) & declared);
}

// Commands only reach the actuators that the response has declared, whatever its thread says.
void BehaviorLayer::put_out(ActuatorMask declared) {
  const std::size_t words = std::exchange(workspace_.result->words, std::uint16_t{0});
  vm::Params& params = command_.order_.params;
  vm::OutputReader reader(workspace_.output.first(std::min(words, workspace_.output.size())),
                          params);
  vm::Output said;
  while (reader.next(said)) {
    if (said.kind == vm::OutputKind::command) {
      stage(said, declared);
    } else {
      report_text(layers_.trace, said, params, layers_.trace.step());
    }
  }
}

void BehaviorLayer::retire(unsigned behavior) {
  const vm::Behavior& wiring = program_->image.behaviors[behavior];
  for (unsigned r = 0; r < wiring.rule_count; ++r)
    layers_.triggers.retire(wiring.first_rule + r);
  retired_ |= bit<BehaviorMask>(behavior);
  if (behavior == released_) is_released_ = false;
}

bool BehaviorLayer::claim_of(unsigned rule, Claim& claim, bool& silent) const {
  Triggers::Wish wish;
  if (!layers_.triggers.wish(rule, layers_.arbiter.works(rule), wish)) return false;
  if (!wish.fresh && rest_left(rule, snapshot_->milliseconds()) != 0) return false;
  silent = wish.silent;
  return claim_for(rule, wish.side, !wish.fresh, claim);
}

bool BehaviorLayer::will_claim(unsigned rule, Claim& claim) const {
  Triggers::Wish wish;
  return layers_.triggers.wish(rule, layers_.arbiter.works(rule), wish) &&
         claim_for(rule, wish.side, !wish.fresh, claim);
}

bool BehaviorLayer::claim_for(unsigned rule, Side side, bool retries, Claim& claim) const {
  const vm::Rule& wiring = program_->image.rules[rule];
  const unsigned response = side == Side::then ? wiring.then_response : wiring.else_response;
  if (response == vm::kNoIndex) return false;  // a behaviour can claim that its rule has an ELSE
  claim = {.rule = static_cast<std::uint16_t>(rule),
           .behavior = program_->behavior_of[rule],
           .side = side,
           .actuators = program_->image.responses[response].actuators,
           .restarting = policy::modifiers_of(program_->image, wiring).restarting != 0,
           .retries = retries};
  return true;
}

// --- a behaviour's thread: unprivileged, behind the MPU ---

// It reads the program, the snapshot, this layer, the triggers and the arbiter. It writes its stack
// and the workspace. It calls the kernel through kernel/calls.def. Anything else would stop it. It may
// rely on the verifier: responses end within the step's budget and kMaxResponseOutput words.

void BehaviorLayer::run(Unit& unit) {
  vm::Machine machine = layers_.frames.machine(*program_, unit.behavior);
  (void)kernel::calls::wait(kernel_, kReleased);
  while (true) {
    latch(unit, machine);
    do_task(unit, machine);
    workspace_.finished->store(true, std::memory_order_relaxed);
    kernel::calls::rest(kernel_, kReleased);
  }
}

[[gnu::always_inline]] inline void BehaviorLayer::begin_response(vm::Machine& machine,
                                                                 const Claim& claim) {
  run_response(machine, claim.rule, claim.side, begin_of(claim.rule, claim.side));
}

[[gnu::always_inline]] inline void BehaviorLayer::do_task(const Unit& unit, vm::Machine& machine) {
  if (task_ == Task::sole_turn) return run_sole_turn(rule_, machine);
  if (task_ == Task::response) {
    machine.left_ms = rest_left(rule_, machine.now);
    return run_response(machine, rule_, Side::then, code_);
  }
  evaluate_rules(unit, machine);
  if (Claim claim; sole_claim(program_->rules_of(unit.behavior), claim))
    begin_response(machine, claim);
}

// evaluate_rules() and sole_claim() for one rule. A response that waits claims nothing unless something ends it.
void BehaviorLayer::run_sole_turn(unsigned rule, vm::Machine& machine) {
  layers_.triggers.begin_sole_turn(rule);
  judge_rule(rule, machine);
  if (Side side{}; layers_.triggers.fired(rule, side) && !layers_.triggers.is_while(rule) &&
                   surely_begins(rule, side))
    return run_response(machine, rule, side, begin_of(rule, side));
  Claim claim;
  bool silent = false;
  const bool claims =
      layers_.triggers.may_want(rule) && !must_pause(rule) && claim_of(rule, claim, silent);
  if (resume_points_[rule].pause != vm::Pause::ended) {
    if (goes_on_ && !claims && !layers_.triggers.is_over(rule)) {
      machine.left_ms = rest_left(rule, machine.now);
      run_response(machine, rule, Side::then, resume_points_[rule].next);
      workspace_.result->there = Result::kWentOn;
    }
  } else if (claims && layers_.arbiter.wins(claim)) {
    begin_response(machine, claim);
  }
}

// The common cases: its response takes actuators from nobody, or only from its own other side.
[[gnu::always_inline]] inline bool BehaviorLayer::surely_begins(unsigned rule, Side side) const {
  return response_of(rule, side) != vm::kNoIndex &&
         layers_.arbiter.surely_wins(rule, side, actuators_of(rule, side));
}

void BehaviorLayer::latch(const Unit& unit, vm::Machine& machine) {
  Frames::latch(machine, program_->image, program_->image.behaviors[unit.behavior],
                [values = snapshot_->values()](std::uint8_t input) { return values[input]; });
  machine.now = snapshot_->milliseconds();
  machine.wake = kNever;
}

void BehaviorLayer::evaluate_rules(const Unit& unit, vm::Machine& machine) {
  const RuleRange rules = program_->rules_of(unit.behavior);
  layers_.triggers.begin_turn(rules);
  concerned_->each_in(rules, [&](unsigned rule) { judge_rule(rule, machine); });
}

void BehaviorLayer::judge_rule(unsigned rule, vm::Machine& machine) {
  const vm::RuleKind kind = program_->image.rules[rule].kind;
  if (kind == vm::RuleKind::start) {
    layers_.triggers.note(rule);
    layers_.triggers.begin(rule);
  } else if (kind == vm::RuleKind::every) {
    evaluate_period(rule, machine);
  } else {
    const vm::Value condition = evaluate_rule(rule, machine);
    if (kind != vm::RuleKind::watch)
      return layers_.triggers.judge(rule, condition, machine.wake, machine.event);
    machine.frame[program_->truth_cell[rule]] = condition;
    layers_.triggers.note_past(rule, machine.wake, machine.event);
  }
}

[[gnu::always_inline]] inline vm::Value BehaviorLayer::evaluate_rule(unsigned rule,
                                                                     vm::Machine& machine) {
  machine.event = false;
  machine.wake = kNever;
  const vm::Value value =
      vm::evaluate(machine, &program_->image.code[program_->image.rules[rule].condition_start]);
  if (std::exchange(machine.divided_by_zero, false)) layers_.triggers.note_zero_divide(rule);
  return value;
}

void BehaviorLayer::evaluate_period(unsigned rule, vm::Machine& machine) {
  if (!layers_.triggers.begin_period(rule, machine.now)) return;
  layers_.triggers.note(rule);
  layers_.triggers.draw_period(rule, evaluate_rule(rule, machine), machine.now);
}

// True if the behaviour runs exactly one response in this step, and that one begins and wins. With
// several, the step thread must see to their order, and to the ownership after each. Not inlined, so that it is off the stack
// while rules are evaluated.
[[gnu::noinline]] bool BehaviorLayer::sole_claim(RuleRange rules, Claim& claim) const {
  if (waits(rules)) return false;
  unsigned found = 0;
  layers_.triggers.each_wanting(rules, [&](unsigned rule) {
    bool silent = false;
    if (!must_pause(rule) && claim_of(rule, claim, silent)) ++found;
  });
  return found == 1 && layers_.arbiter.wins(claim);
}

// One of its responses waits, and may go on in this step.
[[gnu::noinline]] bool BehaviorLayer::waits(RuleRange rules) const {
  bool waits = false;
  layers_.arbiter.running().each_in(
      rules, [&](unsigned rule) { waits |= resume_points_[rule].pause != vm::Pause::ended; });
  return waits;
}

void BehaviorLayer::run_response(vm::Machine& machine, unsigned rule, Side side, unsigned code) {
  machine.output = workspace_.output.data();
  machine.output_end = workspace_.output.data() + workspace_.output.size();
  machine.shifted = 0;
  machine.assigned = 0;
  machine.wake = kNever;
  const vm::Progress progress = vm::respond(machine, &program_->image.code[code]);
  *workspace_.result = {
      .next = progress.next,
      .wake = progress.wake,
      .pause = progress.pause,
      .zero_divide = static_cast<std::uint8_t>(std::exchange(machine.divided_by_zero, false)),
      .rule = static_cast<std::uint16_t>(rule),
      .assigned = machine.assigned,
      .shifted = machine.shifted,
      .words = static_cast<std::uint16_t>(machine.output - workspace_.output.data()),
      .there = Result::kBegan,
      .side = static_cast<std::uint8_t>(side)};
}

}  // namespace robosync::layers
