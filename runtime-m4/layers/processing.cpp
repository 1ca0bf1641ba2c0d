// See processing.hpp: passes, what makes a step, what it concerns, and what happens in it.
#include "runtime-m4/layers/processing.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "runtime-m4/layers/clock.hpp"

namespace robosync::layers {

using link::EventKind;

namespace {

// It has something to do before the first reading: it reads nothing, or what is known at once, or
// it has rules that wait for a time only.
bool starts_at_once(const vm::Image& image, const vm::Behavior& behavior) {
  if (behavior.input_count == 0) return true;
  for (const std::uint8_t input : image.inputs.subspan(behavior.first_input, behavior.input_count))
    if (input >= image.channels.size() &&
        image.variables[input - image.channels.size()].kind != vm::VariableKind::band)
      return true;
  for (const vm::Rule& rule : image.rules.subspan(behavior.first_rule, behavior.rule_count))
    if (rule.kind == vm::RuleKind::start || rule.kind == vm::RuleKind::every) return true;
  return false;
}

}  // namespace

bool ProcessingLayer::start(const LoadedProgram& program) {
  program_ = &program;
  snapshot_.stamp_ = {};
  snapshot_.values_.fill(vm::kUnknown);
  layers_.variables.start(program.image,
                          std::span(snapshot_.values_).subspan(program.image.channels.size()));
  checks_.start(program.image);
  adaptation_.start();
  layers_.triggers.start(program.image);
  holdings_.fill(Holding{});
  running_.clear();
  has_run_.clear();
  cancelled_ = 0;
  lost_behaviors_ = 0;
  unstarted_ = 0;
  untouched_ = 0;
  in_pass_ = false;
  for (unsigned b = program.first_behavior(); b < program.image.behaviors.size(); ++b) {
    untouched_ |= bit<BehaviorMask>(b);
    if (starts_at_once(program.image, program.image.behaviors[b]))
      unstarted_ |= bit<BehaviorMask>(b);
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
    if ((kernel_.wait(kNews | kIdle | kStopped | kHalted, next) & kStopped) != 0) note_stops();
    in_pass_ = true;
    pass();
    passes_ += 1;
    in_pass_ = false;
    next = lost_behaviors_ != 0 ? 0 : next_time();
  }
}

void ProcessingLayer::pass() {
  adaptation_.turn(*program_, layers_.threads, trace_, now_ms());
  finish_done();
  const BehaviorMask lost = std::exchange(lost_behaviors_, 0);
  const BehaviorMask first = std::exchange(unstarted_, 0);
  const ActuatorMask halted = layers_.control.take_halted() & owned();
  layers_.triggers.settle(now_ms());
  const bool due = next_due(now_ms()) == 0;
  InputMask changed = 0;
  if (!latch(lost != 0 || first != 0 || halted != 0 || due, changed)) return;
  layers_.alarm.ring(changed >> channels() << channels());  // the sensors have rung for theirs
  cancelled_ = 0;
  interrupt_lost(lost);
  interrupt_halted(halted);
  find_concerned(changed, first);
  step();
}

std::uint32_t ProcessingLayer::now_ms() const {
  return static_cast<std::uint32_t>(trace_.program_time() / kernel::kTick);
}

// --- what ended since the last pass ---

void ProcessingLayer::finish_done() {
  const ActuatorMask idle = layers_.control.take_idle();
  for (const unsigned rule : running_) {
    Holding& holding = holdings_[rule];
    holding.pending = static_cast<ActuatorBits>(holding.pending & ~idle);
    finish_if_done(rule);
  }
}

void ProcessingLayer::finish_if_done(unsigned rule) {
  if (holdings_[rule].pending != 0) return;
  if (layers_.behaviors.resume_point(rule).pause != vm::Pause::ended) return;
  running_.erase(rule);
  trace_.emit(EventKind::finished, trace_.now(), rule);
}

ActuatorMask ProcessingLayer::owned() const {
  ActuatorMask owned = 0;
  for (const unsigned rule : running_)
    owned |= holdings_[rule].actuators;
  return owned;
}

// --- latch ---

// Takes what is new into the snapshot. A step begins if there is a reading, or `anyway`.
bool ProcessingLayer::latch(bool anyway, InputMask& changed) {
  const Stamp stamp{kernel_.now() - trace_.activated_at(), trace_.step().step + 1};
  if (anyway) trace_.begin_step(stamp);
  changed = latch_channels(stamp);
  if (!anyway && changed == 0) return false;
  snapshot_.stamp_ = stamp;
  changed |= latch_variables(stamp);
  return true;
}

InputMask ProcessingLayer::latch_channels(Stamp stamp) {
  const InputMask announced = layers_.mailboxes.take_announced();
  const kernel::Time now = stamp.time + trace_.activated_at();
  const InputMask changed =
      announced | layers_.mailboxes.take_expired(program_->image.channels, announced, now);
  for (InputMask left = changed; left != 0; left &= left - 1) {
    const auto c = static_cast<unsigned>(std::countr_zero(left));
    const bool fresh = has(announced, c);
    trace_.begin_step(stamp);
    const vm::Value value = fresh ? layers_.mailboxes.value(c) : vm::kUnknown;
    snapshot_.values_[c] = value;
    if (fresh) {
      trace_.emit(EventKind::input, stamp, c, 0, value);
    } else {
      trace_.emit(EventKind::stale, stamp, c);
    }
  }
  return changed;
}

InputMask ProcessingLayer::latch_variables(Stamp stamp) {
  const std::span<vm::Value> values = snapshot_.values_;
  const std::uint32_t now = snapshot_.milliseconds();
  const VariableMask set = layers_.variables.enter(now, values.subspan(channels()));
  for (VariableMask left = set; left != 0; left &= left - 1)
    report_set(static_cast<unsigned>(std::countr_zero(left)), stamp);
  VariableMask bands = 0;
  for (unsigned c = 0; c < program_->image.checks.size(); ++c) {
    if (!checks_.update(c, now, values)) continue;
    const unsigned band = program_->image.checks[c].variable;
    bands |= bit<VariableMask>(band);
    report_set(band, stamp);
  }
  return InputMask{set | bands} << channels();
}

void ProcessingLayer::report_set(unsigned variable, Stamp stamp) {
  const vm::Value value = snapshot_.values_[channels() + variable];
  trace_.emit(EventKind::set, stamp, variable, 0, value);
}

// --- what is due without a reading ---

// In how many milliseconds something is; kNever for never.
std::uint32_t ProcessingLayer::next_due(std::uint32_t now) const {
  Soonest due(now);
  if (layers_.variables.staged()) due.at(set_due_);
  due.in(layers_.variables.next_fade(now, std::span(snapshot_.values_).subspan(channels())));
  due.in(checks_.next(now));
  due.at(layers_.triggers.next_wake());
  for (const unsigned rule : running_)
    add_waiting(rule, due);
  for (const unsigned rule : layers_.triggers.active())
    if (!running_.has(rule)) add_wanting(rule, due, now);
  return due.delay();
}

// A response that waits.
void ProcessingLayer::add_waiting(unsigned rule, Soonest& due) const {
  const BehaviorLayer::ResumePoint& point = layers_.behaviors.resume_point(rule);
  if (point.pause == vm::Pause::ended) return;
  if (point.pause == vm::Pause::until_done && holdings_[rule].pending != 0) return;
  due.at(point.wake);
}

// A rule that wants to run and may.
void ProcessingLayer::add_wanting(unsigned rule, Soonest& due, std::uint32_t now) const {
  due.at(layers_.triggers.cooled_at(rule));
  Claim claim{};
  bool silent = false;
  if (claim_of(rule, claim, silent) && decide_now(claim).wins)
    due.at(has_run(rule, now) ? now + 1 : now);
}

kernel::Time ProcessingLayer::next_time() const {
  const std::uint32_t now = now_ms();
  Soonest soonest(now);
  soonest.in(next_due(now));
  soonest.at(adaptation_.next());
  const std::uint32_t delay = soonest.delay();
  const kernel::Time due =
      delay == kNever ? kernel::kForever : kernel_.now() + kernel::milliseconds(delay);
  return std::min(due, layers_.mailboxes.next_expiry());
}

// --- threads that were stopped ---

void ProcessingLayer::note_stops() {
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

// --- what a step concerns ---

// Only these rules are evaluated; for all others the result would be that of last time:
//
// * What a condition gives depends on its inputs, on the past of its time words and on the time. A
//   time word that changes with time alone says when (Triggers::next_wake()).
// * A time word that was true for one evaluation only is false in the next. That is the next step
//   that stirs its behaviour, and one millisecond later at the latest. A division by zero is told
//   in each of these steps, as long as there is one.
// * An input that only a rule's responses read, or set, concerns it too: it stirs the behaviour,
//   and responses that wait for something look again (goes_on()).
// * The first time, all rules of a behaviour are evaluated: there are conditions without inputs,
//   and such that are known whatever their inputs are.
//
// `begins`: behaviours that have something to do without a reading.
void ProcessingLayer::find_concerned(InputMask changed, BehaviorMask begins) {
  concerned_.clear();
  changed_ = changed;
  woken_ = begins;
  layers_.triggers.add_woken(snapshot_.milliseconds(), concerned_);
  for (const unsigned rule : concerned_)
    woken_ |= bit<BehaviorMask>(program_->behavior_of[rule]);
  for (InputMask left = changed; left != 0; left &= left - 1)
    concerned_ |= program_->readers[static_cast<unsigned>(std::countr_zero(left))];
  for (const unsigned rule : layers_.triggers.eventful())
    if (stirred(program_->behavior_of[rule])) concerned_.insert(rule);
  for (BehaviorMask left = untouched_; left != 0; left &= left - 1) {
    const auto behavior = static_cast<unsigned>(std::countr_zero(left));
    if (behavior >= program_->image.behaviors.size()) break;
    if (stirred(behavior)) concern_all(behavior);
  }
}

void ProcessingLayer::concern_all(unsigned behavior) {
  untouched_ &= ~bit<BehaviorMask>(behavior);
  const vm::Behavior& wiring = program_->image.behaviors[behavior];
  for (unsigned r = 0; r < wiring.rule_count; ++r)
    concerned_.insert(wiring.first_rule + r);
}

// Something that it reads has changed, or the time of one of its rules has come.
bool ProcessingLayer::stirred(unsigned behavior) const {
  return has(woken_, behavior) || (program_->inputs[behavior] & changed_) != 0;
}

// --- a step, from the changed inputs to the commands ---

void ProcessingLayer::step() {
  const std::uint32_t now = snapshot_.milliseconds();
  if (now != ran_at_) has_run_.clear();
  ran_at_ = now;
  layers_.behaviors.evaluate(concerned_, snapshot_);
  await(kFinished, [this] { return layers_.behaviors.busy(); });
  layers_.triggers.collect(concerned_);
  layers_.triggers.settle(now);
  report_triggers();
  interrupt_over();
  arbitrate();
  cancel_interrupted();
  run_responses();
  set_due_ = now + 1;
  layers_.control.commit();
  for (const unsigned rule : running_) {
    finish_if_done(rule);
    holdings_[rule].won_now = false;  // what is due next is looked for as if the step were over
  }
}

// --- interruptions that no claim is the cause of ---

void ProcessingLayer::interrupt_lost(BehaviorMask lost) {
  if (lost == 0) return;
  for (const unsigned rule : running_)
    if (has(lost, holdings_[rule].behavior)) interrupt(rule, holdings_[rule].behavior);
}

void ProcessingLayer::interrupt_halted(ActuatorMask halted) {
  if (halted == 0) return;
  for (const unsigned rule : running_)
    if ((holdings_[rule].actuators & halted) != 0) interrupt(rule, vm::kSafetyBehavior);
}

void ProcessingLayer::interrupt_over() {
  for (const unsigned rule : running_)
    if (layers_.triggers.is_over(rule)) interrupt(rule, holdings_[rule].behavior);
}

// --- claims ---

void ProcessingLayer::report_triggers() {
  for (const unsigned rule : concerned_)
    if (layers_.triggers.take_zero_divide(rule))
      trace_.emit(EventKind::zero_divide, trace_.step(), rule);
  Side side{};
  for (const unsigned rule : concerned_)
    if (layers_.triggers.fired(rule, side)) {
      trace_.emit(EventKind::fire, trace_.step(), rule, 0, static_cast<std::int32_t>(side));
      adaptation_.count(*program_, program_->behavior_of[rule], snapshot_.milliseconds());
    }
}

// What `rule` claims now; silent: that it does was told before.
bool ProcessingLayer::claim_of(unsigned rule, Claim& claim, bool& silent) const {
  Triggers::Wish wish{};
  if (!layers_.triggers.wish(rule, running_.has(rule), wish)) return false;
  silent = wish.silent;
  const std::uint16_t response = layers_.behaviors.response_of(rule, wish.side);
  claim = {.rule = static_cast<std::uint16_t>(rule),
           .behavior = program_->behavior_of[rule],
           .side = wish.side,
           .actuators = program_->image.responses[response].actuators,
           .restarting = layers_.triggers.restarting(rule),
           .retries = !wish.fresh};
  return true;
}

void ProcessingLayer::arbitrate() {
  const std::uint32_t now = snapshot_.milliseconds();
  Claim claim{};
  bool silent = false;
  RuleSet wanting = concerned_;
  wanting |= layers_.triggers.active();
  for (const unsigned rule : wanting) {
    const bool again =
        program_->image.rules[rule].kind == vm::RuleKind::while_ && has_run(rule, now);
    if (!again && claim_of(rule, claim, silent)) serve(claim, silent);
  }
  layers_.triggers.forget(concerned_);
}

void ProcessingLayer::serve(const Claim& claim, bool silent) {
  const Decision decision = decide_now(claim);
  const bool was_running = running_.has(claim.rule);
  for (const unsigned rule : decision.interrupted)
    interrupt(rule, claim.behavior);
  if (!decision.wins) {
    if (!silent) report(claim, EventKind::lose, decision.owner);
    const bool to_itself = was_running && running_.has(claim.rule);
    layers_.triggers.lost(claim.rule, claim.side, to_itself, snapshot_.milliseconds());
    return;
  }
  report(claim, EventKind::win);
  layers_.triggers.won(claim.rule, snapshot_.milliseconds());
  running_.insert(claim.rule);
  holdings_[claim.rule] = Holding{.actuators = static_cast<ActuatorBits>(claim.actuators),
                                  .pending = 0,
                                  .behavior = claim.behavior,
                                  .side = claim.side,
                                  .won_now = true};
}

void ProcessingLayer::interrupt(unsigned rule, unsigned by) {
  trace_.emit(EventKind::interrupt, trace_.step(), rule, by);
  cancelled_ |= holdings_[rule].actuators;
  running_.erase(rule);
  layers_.behaviors.forget_resume_point(rule);
  layers_.triggers.interrupted(rule);
}

void ProcessingLayer::report(const Claim& claim, EventKind kind, unsigned object) {
  trace_.emit(kind, trace_.step(), claim.rule, object, static_cast<std::int32_t>(claim.side));
}

// --- responses ---

bool ProcessingLayer::goes_on(unsigned rule) const {
  const Holding& holding = holdings_[rule];
  const BehaviorLayer::ResumePoint& point = layers_.behaviors.resume_point(rule);
  const std::uint32_t now = snapshot_.milliseconds();
  if (point.pause == vm::Pause::ended || has_run(rule, now)) return false;
  const bool due = point.wake != kNever && reached(point.wake, now);
  switch (point.pause) {
    case vm::Pause::until_done:
      return due && holding.pending == 0;
    case vm::Pause::polling:
    case vm::Pause::still_polling:
      return due || stirred(holding.behavior);
    default:
      return due;
  }
}

void ProcessingLayer::run_responses() {
  for (const unsigned rule : running_) {
    Holding& holding = holdings_[rule];
    if (holding.won_now) {
      layers_.behaviors.respond(rule, holding.side);
    } else if (goes_on(rule)) {
      layers_.behaviors.go_on(rule);
    } else {
      continue;
    }
    await(kFinished, [this] { return layers_.behaviors.busy(); });
    layers_.behaviors.conclude(rule);
    has_run_.insert(rule);
    holding.pending = static_cast<ActuatorBits>(holding.pending | layers_.control.take_staged());
    for (ActuatorMask dropped = layers_.control.take_dropped(); dropped != 0;
         dropped &= dropped - 1)
      trace_.emit(EventKind::overrun, trace_.step(),
                  static_cast<unsigned>(std::countr_zero(dropped)));
  }
}

// The old ones end before the new ones begin, and before those send commands: what the old ones had
// in their queues takes no place from them.
void ProcessingLayer::cancel_interrupted() {
  if (cancelled_ == 0) return;
  layers_.control.cancel(cancelled_);
  await(kCancelled, [this] { return layers_.control.cancelling(); });
}

}  // namespace robosync::layers
