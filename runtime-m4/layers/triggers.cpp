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

}  // namespace

void Triggers::start(const vm::Image& image) {
  image_ = &image;
  states_.fill(State{});
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
  State& state = states_[rule];
  if (!state.has_period) return true;
  if (!reached(state.period_end, now)) return false;
  state.trigger = Trigger::then;
  return true;
}

// Counted from the end of the last period, so that they do not drift; one that is over already is
// skipped.
void Triggers::draw_period(unsigned rule, vm::Value thousandths, std::uint32_t now) {
  State& state = states_[rule];
  const std::uint32_t begin = state.has_period ? state.period_end : now;
  state.has_period = thousandths != vm::kUnknown;
  if (!state.has_period) return;
  state.period_end = begin + std::max<std::uint32_t>(milliseconds_of(thousandths), 1);
  if (reached(state.period_end, now)) state.period_end = now + 1;
}

std::uint32_t Triggers::next_period(unsigned rule) const {
  const State& state = states_[rule];
  return state.has_period ? state.period_end : kNever;
}

// --- what follows from it ---

void Triggers::settle(std::uint32_t now) {
  for (State& state : states_) {
    const bool cooling = state.phase == Phase::cooling;
    const bool over = cooling ? reached(state.until, now) : !reached(now, state.until);
    if (over) state.phase = Phase::free;
    if (cooling && !over) state.trigger = Trigger::none;
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
  state.until = now + cooldown;
}

// A WHILE goes on wanting anyway; and who runs already does not wait for himself.
void Triggers::lost(unsigned rule, Side side, bool to_itself, std::uint32_t now) {
  State& state = states_[rule];
  state.told = true;
  const std::uint32_t waiting = milliseconds_of(modifiers(rule).waiting);
  if (state.trigger == Trigger::none || waiting == 0 || to_itself || is_while(rule)) return;
  state.phase = side == Side::then ? Phase::wants_then : Phase::wants_otherwise;
  state.until = now + waiting;
}

void Triggers::forget_all() {
  for (State& state : states_)
    state.trigger = Trigger::none;
}

void Triggers::retire(unsigned rule) {
  states_[rule] = State{};
}

std::uint32_t Triggers::cooled_at(unsigned rule) const {
  const State& state = states_[rule];
  const bool cools = is_while(rule) && state.truth == Truth::yes && state.phase == Phase::cooling;
  return cools ? state.until : kNever;
}

}  // namespace robosync::layers
