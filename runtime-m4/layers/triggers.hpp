// When rules trigger: the state kept of their conditions, periods, cooldowns and waits.
//
// A rule remembers the last known truth of its condition. WHEN triggers when that becomes true,
// WHEN/ELSE when it changes; the first known truth counts as a change; a truth that is an event
// (BECOMES, CHANGES …) triggers each time. A WHEN/ELSE keeps wanting its chosen side until that side
// is the one that ran last, also while that side cools down. A side that triggered and lost counts as not run, although it may
// have run before: something else has had its actuators since. An unknown condition does nothing and is not
// remembered, so a sensor that drops out and comes back does not trigger by that alone. WHILE differs: unknown
// ends it, so it fires again when its condition is known to be true.
//
// Each side of a rule cools down separately.
//
// Each behaviour's thread records what it has evaluated of its own rules and asks what follows
// from it; the step thread collects the records and asks the same. Rules that depend on the past (a wait, a
// cooldown, a WHILE that holds, a time word) are in sets, so all other rules cost a step nothing.
// The sets belong to the step thread; the others only read them. Times are milliseconds of program
// time.
#pragma once

#include <array>
#include <cstdint>

#include "runtime-m4/layers/arbiter.hpp"
#include "runtime-m4/layers/clock.hpp"
#include "runtime-m4/layers/messages.hpp"
#include "runtime-m4/layers/rule_set.hpp"
#include "runtime-m4/layers/workspace.hpp"
#include "vm/interpreter.hpp"

namespace robosync::layers {

class Triggers {
public:
  explicit Triggers(Workspace& workspace) : workspace_(workspace) {}

  [[gnu::cold]] void start(const vm::Image& image, Memory& memory);

  // --- for the behaviour of the rule ---
  // The rule's condition was evaluated. It may change at `wake` (kNever: not with time alone). `event`: it had an event, which
  // is over at the next evaluation.
  void judge(unsigned rule, vm::Value condition, std::uint32_t wake, bool event);
  // … of a rule without a response.
  void note_past(unsigned rule, std::uint32_t wake, bool event);
  // An AT START rule.
  void begin(unsigned rule);
  // An EVERY rule: triggers if its time has come. True if its next period must be drawn.
  [[nodiscard]] bool begin_period(unsigned rule, std::uint32_t now);
  void draw_period(unsigned rule, vm::Value thousandths, std::uint32_t now);
  // A turn begins: nothing follows yet.
  void begin_turn(RuleRange rules) { noted().clear_around(rules); }
  void begin_sole_turn(unsigned rule) { noted().erase(rule); }
  // The rule's evaluation has consequences.
  [[gnu::always_inline]] void note(unsigned rule) { noted().insert(rule); }
  void note_zero_divide(unsigned rule) { judgement(rule).zero_divide = true; }

  // --- for the step thread ---
  // Of the evaluated rules, keeps only those whose evaluation has consequences now, or may end what is remembered of
  // them.
  void keep_concerned(RuleSet& evaluated, RuleRange rules) const {
    evaluated.keep_in(rules, noted(), eventful_.bits(), active_.bits(), sleeping_.bits());
  }
  // … and would it keep this one?
  [[nodiscard]] bool follows(unsigned rule) const {
    return noted().has(rule) || active_.has(rule) || eventful_.has(rule) || sleeping_.has(rule);
  }
  // The rule was evaluated, and its behaviour has finished its task.
  void collect(unsigned rule);
  // Those whose last evaluation had an event, or divided by zero, which is reported in each step that
  // could have found it.
  const RuleSet& eventful() const { return eventful_; }
  // Those that are cooling down, or may want to run without a new trigger.
  const RuleSet& active() const { return active_; }
  // The first time at which a rule must be evaluated again; kNever for never.
  std::uint32_t next_wake() const { return next_wake_; }
  // Adds the rules whose time has come.
  void add_woken(std::uint32_t now, RuleSet& rules) const;
  // Ends cooldowns and waits that are over.
  void settle(std::uint32_t now) {
    if (!active_.empty()) settle_active(now);
  }
  bool take_zero_divide(unsigned rule);
  [[gnu::always_inline]] bool is_while(unsigned rule) const { return phases_[rule].is_while; }
  // A WHILE whose condition does not hold.
  bool is_over(unsigned rule) const;
  // The outcome of its wish, or of its response.
  void won(unsigned rule, Side side, std::uint32_t now);
  void lost(unsigned rule, bool to_itself, std::uint32_t now);
  void interrupted(unsigned rule) { phases_[rule].told = true; }
  void forget(unsigned rule) { judgement(rule).trigger = Trigger::none; }
  // Its behaviour was stopped: it never triggers again.
  [[gnu::cold]] void retire(unsigned rule);
  // A WHILE whose condition holds: after a round there is another.
  [[gnu::always_inline]] bool goes_round(unsigned rule) const {
    return is_while(rule) && judgement(rule).truth == Truth::yes;
  }
  // It cools down or waits: settle() ends that.
  bool is_delayed(unsigned rule) const {
    return phases_[rule].cooling != 0 || phases_[rule].waiting;
  }
  // When a rule that wants to run has cooled down; kNever if it does not want to.
  std::uint32_t cooled_at(unsigned rule) const;

  // --- for both ---
  struct Wish {
    Side side;
    bool fresh;   // it triggered in this step
    bool silent;  // the trace was told before that the rule wants this
  };
  // It triggered in this step, outside a cooldown.
  [[nodiscard]] bool fired(unsigned rule, Side& side) const {
    const Trigger trigger = judgement(rule).trigger;
    side = trigger == Trigger::then ? Side::then : Side::otherwise;
    return trigger != Trigger::none && !cools(rule, side);
  }
  // Those that may want to run: because of an evaluation in this turn, or since earlier.
  template <class Take>
  void each_wanting(RuleRange rules, Take take) const {
    active_.each_in_either(noted(), rules, take);
  }
  [[nodiscard]] bool may_want(unsigned rule) const {
    return active_.has(rule) || noted().has(rule);
  }
  bool has_triggered(unsigned rule) const { return judgement(rule).trigger != Trigger::none; }
  // What it wants to run, given whether it is running. False: nothing.
  [[nodiscard]] bool wish(unsigned rule, bool running, Wish& wish) const;

  bool cools(unsigned rule, Side side) const {
    return (phases_[rule].cooling & mask_of(side)) != 0;
  }

private:
  // What only the step thread knows of a rule. In a mask of sides, bit s is side s.
  struct State {
    std::uint8_t cooling : 2 = 0;  // sides that are cooling down
    std::uint8_t last : 2 =
        0;  // the side that ran last; none at first, and when a trigger has lost since
    bool waiting : 1 = false;  // WAITING, for its one side
    bool told : 1 = false;     // the trace knows that it wants to run and does not
    // From the image, kept here for speed.
    bool is_while : 1 = false;
    bool chooses : 1 = false;  // a WHEN/ELSE
  };
  static_assert(sizeof(State) == 1);
  static constexpr std::uint16_t kNobody = 0xFFFF;
  static constexpr unsigned mask_of(Side side) { return 1U << static_cast<unsigned>(side); }

  RuleBits noted() const { return RuleBits(workspace_.noted.data()); }
  // For a rule with modifiers: the end of its cooldown, by side; also of its waiting, since such a rule has only one side.
  std::uint32_t& until(unsigned rule, Side side) const;
  bool chooses(unsigned rule) const { return phases_[rule].chooses; }
  // A WHEN/ELSE whose chosen side was not the last to run.
  bool is_unsettled(unsigned rule, Side& side) const;
  const vm::Modifiers& modifiers(unsigned rule) const;
  Judgement& judgement(unsigned rule) const { return workspace_.judgements[rule]; }
  std::uint32_t due(unsigned rule) const { return workspace_.due[rule]; }
  void find_truth(Judgement& state, unsigned rule, vm::Value condition, bool event) const;
  void note_past(unsigned rule, Judgement state, std::uint32_t wake, bool event);
  void note_active(unsigned rule);
  void start_phase(unsigned rule);
  void begin_cooldown(unsigned rule, Side side, std::uint32_t now);
  void settle_active(std::uint32_t now);
  void find_first_to_wake();
  void wake_first(unsigned rule) {
    first_to_wake_ = static_cast<std::uint16_t>(rule);
    next_wake_ = due(rule);
  }

  Workspace& workspace_;
  const vm::Image* image_ = nullptr;
  std::span<State> phases_;
  std::span<std::uint16_t> delay_of_;  // by rule with modifiers
  std::span<std::uint32_t> until_;     // see until()
  RuleSet eventful_;
  RuleSet active_;
  RuleSet sleeping_;  // those that will be due at some time
  std::uint16_t first_to_wake_ = kNobody;
  // When that is due. Kept here because, while a behaviour's rules are collected one by one, the workspace already has the
  // newer times that its thread has noted for the others.
  std::uint32_t next_wake_ = kNever;
};

}  // namespace robosync::layers
