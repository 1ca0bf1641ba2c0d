// See triggers.hpp. A state belongs to its behaviour's thread while that is released, and to the
// step thread otherwise.
#include "runtime-m4/layers/triggers.hpp"

#include <algorithm>
#include <utility>

#include "runtime-m4/layers/clock.hpp"

namespace robosync::layers {
namespace {

constexpr vm::Modifiers kPlain{};

// Of a duration in thousandths of a second; none is negative.
std::uint32_t milliseconds_of(vm::Value thousandths) {
  return static_cast<std::uint32_t>(std::max<vm::Value>(thousandths, 0));
}

// kNever is no time: the millisecond after it is taken, once in 49 days.
std::uint32_t as_time(std::uint32_t time) {
  return time == kNever ? 0 : time;
}

}  // namespace

void Triggers::start(const vm::Image& image) {
  image_ = &image;
  states_.fill(State{});
  times_.fill({});
  eventful_.clear();
  active_.clear();
  sleeping_.clear();
  first_to_wake_ = kNobody;
}

const vm::Modifiers& Triggers::modifiers(unsigned rule) const {
  const std::uint8_t index = image_->rules[rule].modifiers;
  return index == vm::kNoModifiers ? kPlain : image_->modifiers[index];
}

// --- what was evaluated ---

void Triggers::judge(unsigned rule, vm::Value condition, bool event) {
  State& state = states_[rule];
  if (condition == vm::kUnknown) {
    if (is_while(rule)) state.truth = Truth::unknown;
    return;
  }
  const Truth truth = condition == vm::kFalse ? Truth::no : Truth::yes;
  const Truth before = state.truth;
  state.truth = truth;
  if (truth == Truth::yes && (before != Truth::yes || event)) state.trigger = Trigger::then;
  if (truth == Truth::no && before != Truth::no &&
      image_->rules[rule].kind == vm::RuleKind::when_else)
    state.trigger = Trigger::otherwise;
  if (truth == Truth::no && is_while(rule)) state.trigger = Trigger::none;
}

void Triggers::begin(unsigned rule) {
  State& state = states_[rule];
  if (state.truth == Truth::unknown) state.trigger = Trigger::then;
  state.truth = Truth::yes;
}

bool Triggers::begin_period(unsigned rule, std::uint32_t now) {
  if (due(rule) == kNever) return true;
  if (!reached(due(rule), now)) return false;
  states_[rule].trigger = Trigger::then;
  return true;
}

// Counted from the end of the last period, so that they do not drift; one that is over already is
// skipped.
void Triggers::draw_period(unsigned rule, vm::Value thousandths, std::uint32_t now) {
  const std::uint32_t begin = due(rule) != kNever ? due(rule) : now;
  std::uint32_t end = begin + std::max<std::uint32_t>(milliseconds_of(thousandths), 1);
  if (reached(end, now)) end = now + 1;
  times_[rule].due = thousandths == vm::kUnknown ? kNever : as_time(end);
}

void Triggers::note_past(unsigned rule, std::uint32_t wake, bool event) {
  times_[rule].due = wake;
  states_[rule].event = event || states_[rule].zero_divide;
}

// --- what follows from it ---

void Triggers::collect(const RuleSet& evaluated) {
  const unsigned first = first_to_wake_;
  bool first_is_gone = false;
  for (const unsigned rule : evaluated) {
    eventful_.put(rule, states_[rule].event);
    sleeping_.put(rule, due(rule) != kNever);
    note_active(rule);
    if (rule == first) first_is_gone = true;
    if (sooner(due(rule), next_wake())) first_to_wake_ = static_cast<std::uint16_t>(rule);
  }
  if (first_is_gone) find_first_to_wake();
}

// It ends a phase, or a WHILE that holds.
void Triggers::note_active(unsigned rule) {
  const State& state = states_[rule];
  active_.put(rule, state.phase != Phase::free || (is_while(rule) && state.truth == Truth::yes));
}

void Triggers::find_first_to_wake() {
  first_to_wake_ = kNobody;
  for (const unsigned rule : sleeping_)
    if (sooner(due(rule), next_wake())) first_to_wake_ = static_cast<std::uint16_t>(rule);
}

void Triggers::add_woken(std::uint32_t now, RuleSet& rules) const {
  if (next_wake() == kNever || !reached(next_wake(), now)) return;
  for (const unsigned rule : sleeping_)
    if (reached(due(rule), now)) rules.insert(rule);
}

void Triggers::settle(std::uint32_t now) {
  for (const unsigned rule : active_) {
    State& state = states_[rule];
    const std::uint32_t until = times_[rule].until;
    const bool cooling = state.phase == Phase::cooling;
    const bool over = cooling ? reached(until, now) : !reached(now, until);
    if (over) state.phase = Phase::free;
    if (cooling && !over) state.trigger = Trigger::none;
    note_active(rule);
  }
}

bool Triggers::take_zero_divide(unsigned rule) {
  return std::exchange(states_[rule].zero_divide, false);
}

bool Triggers::fired(unsigned rule, Side& side) const {
  const Trigger trigger = states_[rule].trigger;
  side = trigger == Trigger::then ? Side::then : Side::otherwise;
  return trigger != Trigger::none;
}

bool Triggers::wish(unsigned rule, bool running, Wish& wish) const {
  const State& state = states_[rule];
  wish = {.side = Side::then, .fresh = false, .silent = state.told};
  if (Side side{}; fired(rule, side)) {
    wish = {.side = side, .fresh = true, .silent = false};
    return true;
  }
  if (is_while(rule)) return state.truth == Truth::yes && !running && state.phase == Phase::free;
  if (state.phase == Phase::wants_otherwise) wish.side = Side::otherwise;
  return state.phase == Phase::wants_then || state.phase == Phase::wants_otherwise;
}

bool Triggers::is_over(unsigned rule) const {
  return is_while(rule) && states_[rule].truth != Truth::yes;
}

bool Triggers::restarting(unsigned rule) const {
  return modifiers(rule).restarting != 0;
}

void Triggers::won(unsigned rule, std::uint32_t now) {
  State& state = states_[rule];
  const std::uint32_t cooldown = milliseconds_of(modifiers(rule).cooldown);
  state.told = false;
  state.phase = cooldown > 0 ? Phase::cooling : Phase::free;
  times_[rule].until = now + cooldown;
  note_active(rule);
}

// A WHILE goes on wanting anyway; and who runs already does not wait for himself.
void Triggers::lost(unsigned rule, Side side, bool to_itself, std::uint32_t now) {
  State& state = states_[rule];
  state.told = true;
  const std::uint32_t waiting = milliseconds_of(modifiers(rule).waiting);
  if (state.trigger == Trigger::none || waiting == 0 || to_itself || is_while(rule)) return;
  state.phase = side == Side::then ? Phase::wants_then : Phase::wants_otherwise;
  times_[rule].until = now + waiting;
  active_.insert(rule);
}

void Triggers::forget(const RuleSet& triggers) {
  for (const unsigned rule : triggers)
    states_[rule].trigger = Trigger::none;
}

void Triggers::retire(unsigned rule) {
  states_[rule] = State{};
  times_[rule] = {};
  eventful_.erase(rule);
  active_.erase(rule);
  sleeping_.erase(rule);
  if (rule == first_to_wake_) find_first_to_wake();
}

std::uint32_t Triggers::cooled_at(unsigned rule) const {
  const State& state = states_[rule];
  const bool cools = is_while(rule) && state.truth == Truth::yes && state.phase == Phase::cooling;
  return cools ? times_[rule].until : kNever;
}

}  // namespace robosync::layers
