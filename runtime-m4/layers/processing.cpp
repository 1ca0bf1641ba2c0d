// See processing.hpp: passes, what makes a step, what it concerns, and what happens in it.
#include "runtime-m4/layers/processing.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "runtime-m4/layers/clock.hpp"
#include "runtime-m4/policy/link_share.hpp"

namespace robosync::layers {

using link::EventKind;

namespace {

// True if it has something to do before the first reading: it reads nothing, or something that is known
// from the start, or it has rules that only wait for a time.
bool starts_at_once(const LoadedProgram& program, const vm::Behavior& behavior) {
  const vm::Image& image = program.image;
  if (behavior.input_count == 0) return true;
  for (const std::uint8_t input : image.inputs.subspan(behavior.first_input, behavior.input_count))
    if (program.is_variable(input) &&
        image.variables[program.variable_of(input)].kind != vm::VariableKind::band)
      return true;
  for (const vm::Rule& rule : image.rules.subspan(behavior.first_rule, behavior.rule_count))
    if (rule.kind == vm::RuleKind::start || rule.kind == vm::RuleKind::every) return true;
  return false;
}

}  // namespace

bool ProcessingLayer::start(const LoadedProgram& program, const Beginnings& beginnings,
                            Memory& memory) {
  program_ = &program;
  snapshot_.milliseconds_ = 0;
  snapshot_.values_ = memory.take<policy::Part::snapshot, vm::Value>();
  std::ranges::fill(snapshot_.values_, vm::kUnknown);
  layers_.variables.start(program.image, snapshot_.values_.subspan(program.image.channels.size()),
                          beginnings, memory);
  report_beginnings();
  thresholds_.start(program.image, memory);
  checks_.start(program.image, memory);
  adaptation_.start(memory);
  concerned_.start(memory.take<policy::Part::concerned, RuleSet::Word>());
  cancelled_ = 0;
  lost_behaviors_ = 0;
  unstarted_ = 0;
  untouched_ = 0;
  untouched_inputs_ = 0;
  in_pass_ = false;
  set_due_ = 0;
  link_share_.start(program.image.header->step_cost);
  for (unsigned b = program.first_behavior(); b < program.image.behaviors.size(); ++b) {
    untouched_ |= bit<BehaviorMask>(b);
    untouched_inputs_ |= program.inputs[b];
    if (starts_at_once(program, program.image.behaviors[b])) unstarted_ |= bit<BehaviorMask>(b);
  }
  kernel::ThreadSpec spec;
  spec.name = "step";
  spec.category = kernel::Category::processing;
  spec.entry = [](void* self) { static_cast<ProcessingLayer*>(self)->run(); };
  spec.argument = this;
  if (!layers_.threads.start_step_thread(thread_, spec)) return false;
  kernel_.watch(thread_, kStopped, kFinished);
  return true;
}

bool ProcessingLayer::resting() const {
  return kernel_.state(thread_) == kernel::Thread::State::blocked &&
         !in_pass_.load(std::memory_order_relaxed);
}

void ProcessingLayer::run() {
  kernel_.wait(kBegin);
  kernel_.sleep_until(trace_.activated_at());
  kernel::Time next = 0;  // the first pass does not wait for news
  while (true) {
    const kernel::Events why = kernel_.wait(kNews | kIdle | kStopped | kHalted, next);
    if ((why & kStopped) != 0) note_stops();
    if (link_share_.is_wanted(kernel_)) [[unlikely]]
      give_way();
    in_pass_.store(true, std::memory_order_relaxed);
    pass();
    passes_.store(passes_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    in_pass_.store(false, std::memory_order_relaxed);
    next = lost_behaviors_ != 0 ? 0 : next_time();
  }
}

void ProcessingLayer::pass() {
  layers_.sensors.deliver_due();
  kernel::Time time = 0;
  const std::uint32_t now = read_clock(time);
  adaptation_.turn(*program_, layers_.threads, trace_, now);
  // Responses that finish in another way do so at the end of a step.
  if (const ActuatorMask idle = layers_.control.take_idle(); idle != 0) finish_done(idle);
  layers_.arbiter.note_halted(layers_.control.halted());
  const ActuatorMask halted = layers_.control.take_halted() & layers_.arbiter.owned();
  layers_.triggers.settle(now);
  const bool lost_or_first = (lost_behaviors_ | unstarted_) != 0;
  const bool anyway = lost_or_first || halted != 0 || is_due(now);
  if (!latch(time, now, anyway)) return;
  set_due_ = now + 1;
  if (!anyway && nothing_follows(now)) return;
  woken_ = 0;
  // The sensors have rung for their own.
  if (variables_of(changed_) != 0) layers_.alarm.ring(inputs(0, variables_of(changed_)));
  if (lost_or_first) [[unlikely]] {
    interrupt_lost(std::exchange(lost_behaviors_, 0));
    woken_ = std::exchange(unstarted_, 0);
  }
  if (halted != 0) interrupt_halted(halted);
  find_concerned();
  step();
}

// Program time, and the same in milliseconds, both from the same tick.
std::uint32_t ProcessingLayer::read_clock(kernel::Time& time) const {
  const auto still = kernel_.lock();
  time = kernel_.time() - trace_.activated_at();
  return trace_.milliseconds();
}

// Of a step in which something was latched: no rule and no response can do anything in it.
bool ProcessingLayer::nothing_follows(std::uint32_t now) const {
  const std::uint32_t wake = layers_.triggers.next_wake();
  return changed_ == 0 && layers_.triggers.active().empty() && layers_.arbiter.running().empty() &&
         (wake == kNever || !reached(wake, now));
}

// Announced readings make a step anyway: then there is no need to look for what is due.
bool ProcessingLayer::is_due(std::uint32_t now) const {
  return !layers_.mailboxes.has_announced() && next_due(now) == 0;
}

// --- what ended since the last pass ---

void ProcessingLayer::finish_done(ActuatorMask idle) {
  layers_.arbiter.running().each([&](unsigned rule) {
    layers_.arbiter.holding(rule).pending &= ~idle;
    finish_if_done(rule);
  });
}

// A WHILE keeps its actuators as long as its condition holds.
void ProcessingLayer::finish_if_done(unsigned rule) {
  if (layers_.arbiter.holding(rule).pending != 0 || layers_.arbiter.rests(rule)) return;
  if (layers_.behaviors.resume_point(rule).pause != vm::Pause::ended) return;
  if (layers_.triggers.goes_round(rule)) {
    layers_.arbiter.rest(rule);
  } else {
    layers_.arbiter.end(rule);
  }
  trace_.emit(EventKind::finished, trace_.now(), rule);
}

// --- latch ---

// Copies what is new into the snapshot. A step begins if there is a reading, or `anyway`.
bool ProcessingLayer::latch(kernel::Time time, std::uint32_t now, bool anyway) {
  const ChannelMask announced = layers_.mailboxes.take_announced();
  const ChannelMask expired =
      layers_.mailboxes.take_expired(program_->image, announced, time + trace_.activated_at());
  if (!anyway && (announced | expired) == 0) return false;
  trace_.begin_step(time);
  const Stamp& stamp = trace_.step();
  snapshot_.milliseconds_ = now;
  const ChannelMask news = latch_channels(announced, expired, stamp);
  changed_ = inputs(news, latch_variables(stamp));
  return true;
}

// Returns those whose new values make a difference to rules.
ChannelMask ProcessingLayer::latch_channels(ChannelMask announced, ChannelMask expired,
                                            const Stamp& stamp) {
  ChannelMask news = 0;
  const bool listening = trace_.listening();
  each_bit(announced | expired, [&](unsigned c) {
    const vm::Value before = snapshot_.values_[c];
    vm::Value value = layers_.mailboxes.value(c);
    if (has(expired, c)) [[unlikely]]
      value = vm::kUnknown;
    snapshot_.values_[c] = value;
    if (is_news(c, before, value)) news |= bit<ChannelMask>(c);
    if (listening) [[unlikely]]
      report_input(c, has(expired, c), stamp);
  });
  return news;
}

void ProcessingLayer::report_input(unsigned channel, bool expired, const Stamp& stamp) {
  if (expired) return trace_.emit(EventKind::stale, stamp, channel);
  trace_.emit(EventKind::input, stamp, channel, 0, snapshot_.values_[channel]);
}

// A rule whose last evaluation had an event is evaluated again when any input of its behaviour changes.
bool ProcessingLayer::is_news(unsigned channel, vm::Value before, vm::Value value) const {
  if constexpr (kernel::kAssertions)
    if (saves_no_work_) return true;
  return thresholds_.separate(channel, before, value) || !layers_.triggers.eventful().empty();
}

VariableMask ProcessingLayer::latch_variables(const Stamp& stamp) {
  const std::span<vm::Value> values = snapshot_.values_;
  const std::uint32_t now = snapshot_.milliseconds();
  VariableMask changed = 0;
  if (layers_.variables.may_change())
    changed = layers_.variables.enter(now, values.subspan(channels()));
  each_bit(changed, [&](unsigned variable) { report_set(variable, stamp); });
  for (unsigned c = 0; c < program_->image.checks.size(); ++c) {
    if (!checks_.update(c, now, values.data())) continue;
    const unsigned band = program_->image.checks[c].variable;
    changed |= bit<VariableMask>(band);
    report_set(band, stamp);
  }
  return changed;
}

// Step 0: these values are there before the first step. A replay needs them.
void ProcessingLayer::report_beginnings() {
  for (unsigned v = 0; v < program_->image.variables.size(); ++v)
    if (snapshot_.values_[channels() + v] != program_->image.variables[v].initial)
      report_set(v, {});
}

void ProcessingLayer::report_set(unsigned variable, const Stamp& stamp) {
  const vm::Value value = snapshot_.values_[channels() + variable];
  trace_.emit(EventKind::set, stamp, variable, 0, value);
}

// --- what is due without a reading ---

// In how many milliseconds something is due; kNever for never.
std::uint32_t ProcessingLayer::next_due(std::uint32_t now) const {
  Soonest due(now);
  if (layers_.variables.may_change()) {
    // At most a millisecond ahead: any other difference means that it has passed, however long ago.
    if (layers_.variables.staged()) due.in(set_due_ - now == 1 ? 1 : 0);
    due.in(layers_.variables.next_fade(now, snapshot_.values_.subspan(channels())));
  }
  if (!program_->image.checks.empty()) due.in(checks_.next(now));
  due.at(layers_.triggers.next_wake());
  layers_.arbiter.running().each([&](unsigned rule) { add_waiting(rule, due); });
  layers_.triggers.active().each([&](unsigned rule) { add_wanting(rule, due, now); });
  return due.delay();
}

// A response that waits.
void ProcessingLayer::add_waiting(unsigned rule, Soonest& due) const {
  const BehaviorLayer::ResumePoint& point = layers_.behaviors.resume_point(rule);
  if (point.pause == vm::Pause::ended) return;
  if (point.pause == vm::Pause::until_done && layers_.arbiter.holding(rule).pending != 0) return;
  due.at(point.time);
}

// A rule that wants to run and may, or whose other side must end for it.
void ProcessingLayer::add_wanting(unsigned rule, Soonest& due, std::uint32_t now) const {
  if (layers_.triggers.is_delayed(rule)) due.in(kLongestRest);
  due.at(layers_.triggers.cooled_at(rule));
  Claim claim{};
  if (!layers_.behaviors.will_claim(rule, claim)) return;
  const Decision decision = layers_.arbiter.decide(claim);
  if (decision.outcome == Outcome::ignored) return;
  if (decision.wins() || layers_.arbiter.works(rule))
    due.in(layers_.behaviors.rest_left(rule, now));
}

kernel::Time ProcessingLayer::next_time() {
  const std::uint32_t now = trace_.milliseconds();
  layers_.arbiter.note_halted(layers_.control.halted());
  Soonest soonest(now);
  soonest.in(next_due(now));
  soonest.at(adaptation_.next());
  const std::uint32_t delay = soonest.delay();
  const kernel::Time due = delay == kNever ? kernel::kForever : trace_.time_after(now, delay);
  return std::min(due, layers_.mailboxes.next_expiry());
}

// --- the link's turn ---

// Lasts until the next tick but one, since the current one may be almost over, or until the link's thread rests. The first wait
// clears a rest from before this turn.
void ProcessingLayer::give_way() {
  const LinkShare::Look begin = link_share_.look(kernel_);
  if (!link_share_.is_due(begin)) return;
  kernel_.wait(kLinkRests, 0);
  kernel_.wait(kLinkRests, kernel_.now() + kernel::milliseconds(policy::kLinkTurnMs));
  link_share_.took(begin, link_share_.look(kernel_));
}

// --- threads that were stopped ---

void ProcessingLayer::note_stops() {
  layers_.algorithms.lower_those_over(layers_.threads);
  for (const ProgramThreads::Member* member = layers_.threads.next_stopped(); member != nullptr;
       member = layers_.threads.next_stopped())
    retire(*member);
}

void ProcessingLayer::retire(const ProgramThreads::Member& member) {
  trace_.emit(EventKind::fault, trace_.now(), member.thread.rank());
  switch (member.thread.category()) {
    case kernel::Category::sensor:
      layers_.sensors.retire(member.index);
      break;
    case kernel::Category::algorithm:
      layers_.algorithms.retire(member.index);
      break;
    case kernel::Category::behavior:
      layers_.behaviors.retire(member.index);
      lost_behaviors_ |= bit<BehaviorMask>(member.index);
      break;
    case kernel::Category::control:
      layers_.control.retire(member.index);
      break;
    default:
      break;
  }
}

// --- which rules a step concerns ---

// Only these rules are evaluated; for all others the result would be the same as last time:
//
// * The result of a condition depends on its inputs, on the past of its time words and on the time. A
//   time word that changes with time alone says when (Triggers::next_wake()).
// * A time word that was true for one evaluation only is false in the next. That is the next step
//   that stirs its behaviour, and one millisecond later at the latest. A division by zero is reported
//   in each of these steps, as long as there is one.
// * An input that only a rule's responses read or set concerns it too: it stirs the behaviour,
//   and responses that wait for a condition check it again (goes_on()).
// * A channel counts as changed only if a rule can tell its new value from the one before
//   (thresholds.hpp).
// * The first time, all rules of a behaviour are evaluated: some conditions have no inputs, and some
//   are known whatever their inputs are.
//
// `woken_` contains the behaviours that have something to do without a reading.
void ProcessingLayer::find_concerned() {
  const InputMask changed = changed_;
  layers_.triggers.add_woken(snapshot_.milliseconds(), concerned_);
  concerned_.each(
      [this](unsigned rule) { woken_ |= bit<BehaviorMask>(program_->behavior_of[rule]); });
  each_bit(channels_of(changed), [this](unsigned c) { program_->add_readers_of(c, concerned_); });
  each_bit(variables_of(changed),
           [this](unsigned v) { program_->add_readers_of(channels() + v, concerned_); });
  layers_.triggers.eventful().each([this](unsigned rule) {
    if (stirred(program_->behavior_of[rule])) concerned_.insert(rule);
  });
  if ((untouched_inputs_ & changed) != 0 || (untouched_ & woken_) != 0) touch();
}

void ProcessingLayer::touch() {
  BehaviorMask still = 0;
  InputMask inputs = 0;
  for (BehaviorMask left = untouched_; left != 0; left &= left - 1) {
    const unsigned behavior = lowest_bit(left);
    if (stirred(behavior)) {
      concerned_.insert_all(program_->rules_of(behavior));
    } else {
      still |= bit<BehaviorMask>(behavior);
      inputs |= program_->inputs[behavior];
    }
  }
  untouched_ = still;
  untouched_inputs_ = inputs;
}

// An input of the behaviour has changed, or one of its rules is due.
bool ProcessingLayer::stirred(unsigned behavior) const {
  return (program_->inputs[behavior] & changed_) != 0 || has(woken_, behavior);
}

// --- a step, from the changed inputs to the commands ---

void ProcessingLayer::step() {
  layers_.behaviors.begin_step(snapshot_);
  cancel_interrupted();
  for (unsigned from = 0; from != RuleSet::kEnd;) {
    const auto [rule, next] = next_at_work(from);
    if (rule == RuleSet::kEnd) break;
    const unsigned behavior = program_->behavior_of[rule];
    const RuleRange rules = program_->rules_of(behavior);
    if (has_sole_turn(rule, next, rules)) {
      take_sole_turn(rule, next == RuleSet::kEnd);
      from = next;
    } else {
      take_turn(behavior, rules);
      from = rules.end;
    }
  }
  layers_.control.commit();
  if (!layers_.arbiter.running().empty()) finish_done(0);
  layers_.arbiter.end_step();
  concerned_.clear();  // here, where it delays no command
}

// The first two rules, from `rule` on, that are concerned, want to run, or run.
RuleSet::Two ProcessingLayer::next_at_work(unsigned rule) const {
  return RuleSet::first_two_of(rule, concerned_, layers_.triggers.active(),
                               layers_.arbiter.running());
}

// True if `rule` is evaluated and no other rule of the behaviour is evaluated, wants to run, or runs; `next` is the first
// such rule after it. A reading mostly finds a behaviour in this case, since most of its rules are about something else.
bool ProcessingLayer::has_sole_turn(unsigned rule, unsigned next, RuleRange rules) const {
  if constexpr (kernel::kAssertions)
    if (saves_no_work_) return false;
  return next >= rules.end && concerned_.has(rule);
}

inline void ProcessingLayer::await_behavior() {
  while (layers_.behaviors.busy())
    if ((kernel_.wait(kFinished | kStopped) & kStopped) != 0) note_stops_at_work();
}

// A turn that does for this one rule all that take_turn() does for each, without looking for others. It does one
// thing sooner: a response that may go on runs in the same activation, like one that begins, unless
// something that the rule has found out ends it.
void ProcessingLayer::take_sole_turn(unsigned rule, bool is_last) {
  const bool may_go_on = layers_.arbiter.runs(rule) && goes_on(rule);
  layers_.behaviors.take_sole_turn(rule, may_go_on);
  await_behavior();
  if (is_last) send_if_undisputed(rule, may_go_on);
  const bool follows = layers_.triggers.follows(rule);
  if (follows) collect(rule);
  if (Claim claim; layers_.behaviors.sole_claim_of({rule, rule + 1}, claim)) {
    const bool wins = decide(claim, false);
    cancel_interrupted();
    if (wins) {
      if (is_last) send_at_once(rule, claim.actuators);
      give(claim);
    }
    layers_.triggers.forget(rule);
    if (wins) conclude(rule);
    return;
  }
  if (follows) arbitrate(rule);
  cancel_interrupted();
  if (!layers_.arbiter.runs(rule)) return;
  if (may_go_on && !layers_.arbiter.won_now(rule) && layers_.behaviors.went_on(rule))
    return conclude(rule);
  run_response(rule);
}

// The commands of the step's last response need not wait for what else follows from it, except for the end of those from
// which it takes actuators. A listener is told of all that first.
[[gnu::always_inline]] inline void ProcessingLayer::send_at_once(unsigned rule,
                                                                 ActuatorMask actuators) {
  if (trace_.listening() || layers_.behaviors.is_retired(program_->behavior_of[rule])) return;
  layers_.behaviors.put_out(actuators);
  layers_.control.commit();
}

[[gnu::always_inline]] inline void ProcessingLayer::send_if_undisputed(unsigned rule,
                                                                       bool may_go_on) {
  const BehaviorLayer& behaviors = layers_.behaviors;
  if (Side side{}; behaviors.has_begun(rule, side)) {
    if (behaviors.begins_undisputed(rule, side))
      send_at_once(rule, behaviors.actuators_of(rule, side));
  } else if (may_go_on && behaviors.went_on(rule)) {
    send_at_once(rule, layers_.arbiter.holding(rule).actuators);
  }
}

void ProcessingLayer::take_turn(unsigned behavior, RuleRange rules) {
  if (concerned_.has_any(rules)) {
    layers_.behaviors.take_turn(behavior, concerned_);
    await_behavior();
    layers_.triggers.keep_concerned(concerned_, rules);
    concerned_.each_in(rules, [this](unsigned rule) { collect(rule); });
    if (Claim claim; layers_.behaviors.sole_claim_of(rules, claim)) {
      const bool wins = serve(claim, false);
      concerned_.each_in(rules, [this](unsigned rule) { layers_.triggers.forget(rule); });
      cancel_interrupted();
      if (wins) conclude(claim.rule);
      return;
    }
  }
  concerned_.each_in_either(layers_.triggers.active().bits(), rules,
                            [this](unsigned rule) { arbitrate(rule); });
  cancel_interrupted();
  layers_.arbiter.running().each_in(rules, [this](unsigned rule) { run_response(rule); });
}

// --- interruptions that no claim causes ---

void ProcessingLayer::interrupt_lost(BehaviorMask lost) {
  layers_.arbiter.running().each([&](unsigned rule) {
    if (const unsigned behavior = program_->behavior_of[rule]; has(lost, behavior))
      interrupt(rule, behavior);
  });
}

void ProcessingLayer::interrupt_halted(ActuatorMask halted) {
  layers_.arbiter.running().each([&](unsigned rule) {
    const ActuatorMask lost = layers_.arbiter.holding(rule).actuators & halted;
    if (lost != 0) interrupt(rule, layers_.control.halter_of(lost));
  });
}

// --- claims ---

// Takes over what the behaviour has found out about a rule. A WHILE whose condition no longer holds ends.
void ProcessingLayer::collect(unsigned rule) {
  layers_.triggers.collect(rule);
  if (layers_.triggers.take_zero_divide(rule))
    trace_.emit(EventKind::zero_divide, trace_.step(), rule);
  if (Side side{}; layers_.triggers.fired(rule, side)) {
    trace_.emit(EventKind::fire, trace_.step(), rule, 0, static_cast<std::int32_t>(side));
    adaptation_.count(*program_, program_->behavior_of[rule], snapshot_.milliseconds());
  }
  if (layers_.arbiter.runs(rule) && layers_.triggers.is_over(rule))
    interrupt(rule, program_->behavior_of[rule]);
}

void ProcessingLayer::arbitrate(unsigned rule) {
  Claim claim;
  bool silent = false;
  if (!layers_.behaviors.must_pause(rule) && layers_.behaviors.claim_of(rule, claim, silent))
    serve(claim, silent);
  layers_.triggers.forget(rule);
}

// Returns whether it won.
bool ProcessingLayer::serve(const Claim& claim, bool silent) {
  const bool wins = decide(claim, silent);
  if (wins) give(claim);
  return wins;
}

// Returns whether it wins; then its actuators are free.
bool ProcessingLayer::decide(const Claim& claim, bool silent) {
  if (!layers_.arbiter.is_free(claim) && !prevails(claim, silent)) return false;
  report(claim, EventKind::win);
  return true;
}

void ProcessingLayer::give(const Claim& claim) {
  layers_.triggers.won(claim.rule, claim.side, snapshot_.milliseconds());
  layers_.arbiter.give(claim);
}

// Decides the claim against the rules whose actuators it wants, and against its own rule.
bool ProcessingLayer::prevails(const Claim& claim, bool silent) {
  const Decision decision = layers_.arbiter.decide(claim);
  interrupt_by(claim, decision);
  if (decision.wins()) return true;
  if (!silent) report(claim, EventKind::lose, in_the_way(claim, decision));
  const bool to_itself = decision.outcome == Outcome::ignored;
  layers_.triggers.lost(claim.rule, to_itself, snapshot_.milliseconds());
  return false;
}

// The owner in the way, as the trace names it.
unsigned ProcessingLayer::in_the_way(const Claim& claim, const Decision& decision) const {
  if (decision.owner != Decision::kHalter) return decision.owner;
  return layers_.control.halter_of(claim.actuators & layers_.arbiter.halted());
}

void ProcessingLayer::interrupt_by(const Claim& claim, const Decision& decision) {
  layers_.arbiter.running().each([&](unsigned rule) {
    if (layers_.arbiter.ends(claim, decision, rule)) interrupt(rule, claim.behavior);
  });
}

// A rule that rests between two rounds has nothing under way: it releases its actuators without an event.
void ProcessingLayer::interrupt(unsigned rule, unsigned by) {
  if (layers_.arbiter.works(rule)) {
    trace_.emit(EventKind::interrupt, trace_.step(), rule, by);
    cancelled_ |= layers_.arbiter.holding(rule).actuators;
  }
  layers_.behaviors.interrupted(rule);
  layers_.arbiter.end(rule);
  layers_.triggers.interrupted(rule);
}

void ProcessingLayer::report(const Claim& claim, EventKind kind, unsigned object) {
  trace_.emit(kind, trace_.step(), claim.rule, object, static_cast<std::int32_t>(claim.side));
}

// --- responses ---

bool ProcessingLayer::goes_on(unsigned rule) const {
  const BehaviorLayer::ResumePoint& point = layers_.behaviors.resume_point(rule);
  const std::uint32_t now = snapshot_.milliseconds();
  if (point.pause == vm::Pause::ended || layers_.behaviors.has_run(rule, now)) return false;
  const bool due = point.time != kNever && reached(point.time, now);
  switch (point.pause) {
    case vm::Pause::until_done:
      return due && layers_.arbiter.holding(rule).pending == 0;
    case vm::Pause::polling:
    case vm::Pause::still_polling:
      return due || stirred(program_->behavior_of[rule]);
    default:
      return due;
  }
}

// For a rule that runs: runs its response if it has won or goes on.
void ProcessingLayer::run_response(unsigned rule) {
  if (layers_.arbiter.won_now(rule)) {
    layers_.behaviors.respond(rule, layers_.arbiter.side(rule));
  } else if (goes_on(rule)) {
    layers_.behaviors.go_on(rule);
  } else {
    return;
  }
  await_behavior();
  conclude(rule);
}

// Another thread was stopped, which may have preempted the behaviour when it had stored that it is finished, but had not made
// the call `rest` yet. That call forgets what the behaviour was released for, so its next task must not come before it.
void ProcessingLayer::note_stops_at_work() {
  note_stops();
  while (layers_.behaviors.is_at_work())
    if ((kernel_.wait(kFinished | kStopped) & kStopped) != 0) note_stops();
}

void ProcessingLayer::conclude(unsigned rule) {
  layers_.behaviors.conclude(rule);
  Holding& holding = layers_.arbiter.holding(rule);
  holding.pending = holding.pending | layers_.control.take_staged();
  for (ActuatorMask dropped = layers_.control.take_dropped(); dropped != 0; dropped &= dropped - 1)
    trace_.emit(EventKind::overrun, trace_.step(),
                static_cast<unsigned>(std::countr_zero(dropped)));
}

// The old responses end before the new ones begin and send commands, so that what the old ones had
// queued takes no place from the new ones.
void ProcessingLayer::cancel_some() {
  while (cancelled_ != 0) {
    cancelled_ &= ~layers_.control.cancel_first(cancelled_);
    await(kCancelled, [this] { return layers_.control.cancelling(); });
  }
}

}  // namespace robosync::layers
