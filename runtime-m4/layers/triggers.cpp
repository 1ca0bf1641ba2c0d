// See triggers.hpp. A judgement belongs to its behaviour's thread while that thread is released, and to
// the step thread otherwise.
#include "runtime-m4/layers/triggers.hpp"

#include <algorithm>

#include "runtime-m4/layers/clock.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::layers {
namespace {

using policy::milliseconds_of;

}  // namespace

void Triggers::start(const vm::Image& image, Memory& memory) {
  image_ = &image;
  std::ranges::fill(workspace_.due, kNever);
  phases_ = memory.take_zero<policy::Part::phases, State>();
  delay_of_ = memory.take<policy::Part::delay_of, std::uint16_t>();
  until_ = memory.take<policy::Part::until, std::uint32_t>();
  std::uint16_t delays = 0;
  for (unsigned rule = 0; rule < image.rules.size(); ++rule) {
    start_phase(rule);
    if (policy::has_delays(image.rules[rule])) delay_of_[rule] = delays++;
  }
  const auto words = memory.take<policy::Part::trigger_sets, RuleSet::Word>();
  eventful_.start(part_of(words, policy::kTriggerSets, 0));
  active_.start(part_of(words, policy::kTriggerSets, 1));
  sleeping_.start(part_of(words, policy::kTriggerSets, 2));
  first_to_wake_ = kNobody;
  next_wake_ = kNever;
}

void Triggers::start_phase(unsigned rule) {
  const vm::RuleKind kind = image_->rules[rule].kind;
  phases_[rule] = {.is_while = kind == vm::RuleKind::while_,
                   .chooses = kind == vm::RuleKind::when_else};
}

const vm::Modifiers& Triggers::modifiers(unsigned rule) const {
  return policy::modifiers_of(*image_, image_->rules[rule]);
}

std::uint32_t& Triggers::until(unsigned rule, Side side) const {
  return until_[policy::kSides * delay_of_[rule] + static_cast<unsigned>(side)];
}

// --- what was evaluated ---

[[gnu::always_inline]] inline void Triggers::note_past(unsigned rule, Judgement state,
                                                       std::uint32_t wake, bool event) {
  workspace_.due[rule] = wake;
  state.event = event || state.zero_divide;
  judgement(rule) = state;
  if (state.event || state.trigger != Trigger::none || wake != kNever) note(rule);
}

[[gnu::always_inline]] inline void Triggers::find_truth(Judgement& state, unsigned rule,
                                                        vm::Value condition, bool event) const {
  if (condition == vm::kUnknown) {
    if (is_while(rule)) state.truth = Truth::unknown;
    return;
  }
  const Truth truth = condition == vm::kFalse ? Truth::no : Truth::yes;
  const Truth before = state.truth;
  state.truth = truth;
  if (truth == Truth::yes && (before != Truth::yes || event)) state.trigger = Trigger::then;
  if (truth == Truth::no && before != Truth::no && chooses(rule))
    state.trigger = Trigger::otherwise;
  if (truth == Truth::no && is_while(rule)) state.trigger = Trigger::none;
}

void Triggers::judge(unsigned rule, vm::Value condition, std::uint32_t wake, bool event) {
  Judgement state = judgement(rule);
  find_truth(state, rule, condition, event);
  note_past(rule, state, wake, event);
}

void Triggers::begin(unsigned rule) {
  Judgement& state = judgement(rule);
  if (state.truth == Truth::unknown) state.trigger = Trigger::then;
  state.truth = Truth::yes;
}

bool Triggers::begin_period(unsigned rule, std::uint32_t now) {
  if (due(rule) == kNever) return true;
  if (!reached(due(rule), now)) return false;
  judgement(rule).trigger = Trigger::then;
  return true;
}

// Counted from the end of the last period, so that periods do not drift; one that is already over is
// skipped.
void Triggers::draw_period(unsigned rule, vm::Value thousandths, std::uint32_t now) {
  const std::uint32_t begin = due(rule) != kNever ? due(rule) : now;
  std::uint32_t end = begin + policy::period_ms(thousandths);
  if (reached(end, now)) end = now + 1;
  workspace_.due[rule] = thousandths == vm::kUnknown ? kNever : as_time(end);
}

void Triggers::note_past(unsigned rule, std::uint32_t wake, bool event) {
  note_past(rule, judgement(rule), wake, event);
}

// --- what follows from it ---

void Triggers::collect(unsigned rule) {
  const bool event = judgement(rule).event;
  if (event || eventful_.has(rule)) eventful_.put(rule, event);
  note_active(rule);
  const std::uint32_t wake = due(rule);
  if (wake == kNever && !sleeping_.has(rule)) return;
  sleeping_.put(rule, wake != kNever);
  if (rule == first_to_wake_) {
    find_first_to_wake();
  } else if (sooner(wake, next_wake_)) {
    wake_first(rule);
  }
}

// Active: the rule cools down or waits, or is a WHILE that holds. lost() adds a WHEN/ELSE that is denied its
// side, which stays as long as it wants that side.
void Triggers::note_active(unsigned rule) {
  const State& state = phases_[rule];
  bool active = state.cooling != 0 || state.waiting || goes_round(rule);
  if (!active && !active_.has(rule)) return;
  if (Side side{}; !active) active = chooses(rule) && is_unsettled(rule, side);
  active_.put(rule, active);
}

bool Triggers::is_unsettled(unsigned rule, Side& side) const {
  const Truth truth = judgement(rule).truth;
  side = truth == Truth::yes ? Side::then : Side::otherwise;
  return truth != Truth::unknown && phases_[rule].last != mask_of(side);
}

void Triggers::find_first_to_wake() {
  first_to_wake_ = kNobody;
  next_wake_ = kNever;
  sleeping_.each([this](unsigned rule) {
    if (sooner(due(rule), next_wake_)) wake_first(rule);
  });
}

void Triggers::add_woken(std::uint32_t now, RuleSet& rules) const {
  if (next_wake() == kNever || !reached(next_wake(), now)) return;
  sleeping_.each([&](unsigned rule) {
    if (reached(due(rule), now)) rules.insert(rule);
  });
}

void Triggers::settle_active(std::uint32_t now) {
  active_.each([&](unsigned rule) {
    State& state = phases_[rule];
    if (!is_delayed(rule)) return;
    for (const Side side : {Side::otherwise, Side::then})
      if (cools(rule, side) && reached(until(rule, side), now))
        state.cooling = static_cast<std::uint8_t>(state.cooling & ~mask_of(side)) & 3U;
    if (state.waiting && !reached(now, until(rule, Side::then))) state.waiting = false;
    note_active(rule);
  });
}

bool Triggers::take_zero_divide(unsigned rule) {
  if (!judgement(rule).zero_divide) return false;
  judgement(rule).zero_divide = false;
  return true;
}

bool Triggers::wish(unsigned rule, bool running, Wish& wish) const {
  const State& state = phases_[rule];
  wish = {.side = Side::then, .fresh = false, .silent = state.told};
  if (Side side{}; fired(rule, side)) {
    wish = {.side = side, .fresh = true, .silent = false};
    return true;
  }
  if (state.is_while) return goes_round(rule) && !running && !cools(rule, Side::then);
  if (state.chooses) return is_unsettled(rule, wish.side) && !cools(rule, wish.side);
  return state.waiting;
}

bool Triggers::is_over(unsigned rule) const {
  return is_while(rule) && judgement(rule).truth != Truth::yes;
}

void Triggers::won(unsigned rule, Side side, std::uint32_t now) {
  State& state = phases_[rule];
  state.told = false;
  state.waiting = false;
  state.last = static_cast<std::uint8_t>(mask_of(side)) & 3U;
  if (policy::has_delays(image_->rules[rule])) begin_cooldown(rule, side, now);
  note_active(rule);
}

void Triggers::begin_cooldown(unsigned rule, Side side, std::uint32_t now) {
  const std::uint32_t cooldown = milliseconds_of(modifiers(rule).cooldown);
  if (cooldown == 0) return;
  State& state = phases_[rule];
  state.cooling = static_cast<std::uint8_t>(state.cooling | mask_of(side)) & 3U;
  until(rule, side) = now + cooldown;
}

// A WHILE and a WHEN/ELSE go on wanting anyway, and a rule that runs already does not wait for itself.
void Triggers::lost(unsigned rule, bool to_itself, std::uint32_t now) {
  State& state = phases_[rule];
  state.told = true;
  if (chooses(rule)) {
    if (has_triggered(rule) && !to_itself) state.last = 0;
    active_.insert(rule);
    return note_active(rule);
  }
  const std::uint32_t waiting = milliseconds_of(modifiers(rule).waiting);
  const bool triggered = judgement(rule).trigger != Trigger::none;
  if (!triggered || waiting == 0 || to_itself || is_while(rule)) return;
  state.waiting = true;
  until(rule, Side::then) = now + waiting;
  active_.insert(rule);
}

void Triggers::retire(unsigned rule) {
  judgement(rule) = Judgement{};
  workspace_.due[rule] = kNever;
  start_phase(rule);
  eventful_.erase(rule);
  active_.erase(rule);
  sleeping_.erase(rule);
  if (rule == first_to_wake_) find_first_to_wake();
}

std::uint32_t Triggers::cooled_at(unsigned rule) const {
  Side side = Side::then;
  const bool wants = chooses(rule) ? is_unsettled(rule, side) : goes_round(rule);
  return wants && cools(rule, side) ? as_time(until(rule, side)) : kNever;
}

}  // namespace robosync::layers
