// See processing.hpp: passes, and what makes a step.
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

bool ProcessingLayer::start(const Program& program) {
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
  if (!layers_.crew.start_step_thread(thread_, spec)) return false;
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
  adaptation_.turn(*program_, layers_.crew, trace_, now_ms());
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
  if (layers_.behaviors.place(rule).pause != vm::Pause::ended) return;
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
  const BehaviorLayer::Place& place = layers_.behaviors.place(rule);
  if (place.pause == vm::Pause::ended) return;
  if (place.pause == vm::Pause::until_done && holdings_[rule].pending != 0) return;
  due.at(place.wake);
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
  for (const Crew::Member* member = layers_.crew.next_stopped(); member != nullptr;
       member = layers_.crew.next_stopped())
    retire(*member);
}

void ProcessingLayer::retire(const Crew::Member& member) {
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

}  // namespace robosync::layers
