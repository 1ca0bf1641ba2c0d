// What a step does on the board, and what that costs at most: which rules a change concerns, what
// their responses put out, what they set.
//
// runtime-m4/policy defines what the runtime does; the costs are those of costs.hpp and of the
// code itself (vm/cost.hpp). Images must be verified.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "analysis/response_work.hpp"
#include "runtime-m4/policy/costs.hpp"
#include "vm/cost.hpp"
#include "vm/image.hpp"
#include "vm/opcode.hpp"

namespace robosync::analysis {

using Actuators = std::uint32_t;
using Rules = std::set<unsigned>;

class StepWork {
public:
  explicit StepWork(const vm::Image& image);

  // Adds what is derived from them in the same step: the bands of CHECKs.
  [[nodiscard]] Inputs with_bands(Inputs changed) const;
  // The rules that a change concerns, except SAFETY rules.
  [[nodiscard]] Rules concerned(const Inputs& changed) const;
  // What the rules' responses may set.
  [[nodiscard]] Inputs sets(const Rules& rules) const;
  // … when one of them goes on after a pause.
  [[nodiscard]] Inputs later_sets(unsigned rule) const { return worst_[rule].later_sets; }
  [[nodiscard]] Actuators actuators(const Rules& rules) const;
  // Those of the rules whose conditions read a changed input: they can fire.
  [[nodiscard]] Rules stirred(const Rules& rules, const Inputs& changed) const;
  // A step in which `changed` has changed and `rules` are evaluated: everything except the sampling and
  // the consequences of rules that fire.
  [[nodiscard]] Instructions step(const Rules& rules, const Inputs& changed) const;
  // The consequences of a rule that fires and wins; 0 if it has no response.
  [[nodiscard]] Instructions firing(unsigned rule) const;
  // … of one that goes on after a pause.
  [[nodiscard]] Instructions going_on(unsigned rule) const;
  // It fires when its condition becomes true, and for no other reason: never twice without being
  // evaluated as false in between. A WHILE also starts again: begins_ms() covers that.
  [[nodiscard]] bool alternates(unsigned rule) const;
  // After it fires, it does not fire again in this time: FOR is its last word; 0: not known.
  [[nodiscard]] std::uint32_t gap_ms(unsigned rule) const;
  // After its response starts, it does not start again in this time; a rule that loses does not cool down.
  [[nodiscard]] std::uint32_t cooldown_ms(unsigned rule) const;
  // At most one response of these two rules runs in a step: they want the same actuator.
  [[nodiscard]] bool contend(unsigned a, unsigned b) const;
  // One look of the safety thread at its rules; and the case that all of them trip.
  [[nodiscard]] Instructions look() const;
  [[nodiscard]] Instructions trips() const;

  [[nodiscard]] bool is_safety(unsigned rule) const;
  [[nodiscard]] unsigned behavior_of(unsigned rule) const { return behavior_of_[rule]; }
  // The inputs that SAFETY rules read: the safety thread looks when one changes.
  [[nodiscard]] const Inputs& watched() const { return watched_; }
  // Its condition has a word that time alone may make true or false.
  [[nodiscard]] bool is_timed(unsigned rule) const {
    return held_ms_[rule] != 0 || has_events(rule);
  }
  // … a word that is true for one step: the rule is evaluated again in the next millisecond.
  [[nodiscard]] bool has_events(unsigned rule) const { return events_[rule] != 0; }
  // … and the rule may fire in that evaluation: not if its condition is true only while one of these words is.
  [[nodiscard]] bool fires_after_event(unsigned rule) const;
  // The shortest time between two evaluations that a FOR causes; 0: it has no FOR.
  [[nodiscard]] std::uint32_t held_ms(unsigned rule) const { return held_ms_[rule]; }
  // The pauses of its responses; not any() for a SAFETY rule.
  [[nodiscard]] const Pauses& pauses(unsigned rule) const { return worst_[rule].pauses; }
  // How soon it may begin again without a trigger from outside: an EVERY, the next round of a WHILE, what may lose its actuators
  // and claim them again. kNever: it does not.
  [[nodiscard]] std::uint32_t begins_ms(unsigned rule) const;
  // The actuators that it holds in each of its pauses.
  [[nodiscard]] Actuators held_while_pausing(unsigned rule) const;

private:
  [[nodiscard]] vm::Word last_word(unsigned rule) const;
  [[nodiscard]] std::uint32_t lasts_ms(std::span<const vm::Word> before, std::uint8_t cell) const;
  void note_held(unsigned rule, std::uint32_t duration_ms);
  void load_rule(unsigned rule, const vm::Behavior& behavior);
  [[nodiscard]] Instructions evaluation(unsigned rule) const;
  [[nodiscard]] Instructions output(unsigned rule) const;
  [[nodiscard]] Instructions interruptions(unsigned rule) const;
  [[nodiscard]] bool reads_channel(const Inputs& changed) const;
  [[nodiscard]] Instructions standing() const;
  [[nodiscard]] Instructions running() const;
  [[nodiscard]] std::uint32_t every_ms(unsigned rule) const;
  [[nodiscard]] bool wants_on(unsigned rule) const;
  [[nodiscard]] bool goes_round(unsigned rule) const {
    return image_.rules[rule].kind == vm::RuleKind::while_;
  }
  [[nodiscard]] policy::ActuatorCosts driver_costs(unsigned actuator) const {
    return policy::actuator_costs(image_, actuator);
  }
  [[nodiscard]] bool may_lose(unsigned rule) const;

  const vm::Image& image_;
  std::vector<vm::RuleCost> costs_;
  Ranges ranges_;
  std::vector<unsigned> behavior_of_;
  std::vector<Inputs> condition_reads_;  // by rule
  std::vector<Inputs> reads_;            // … and its responses read
  std::vector<Inputs> sets_;
  std::vector<ResponseWork> worst_;  // by rule: the worse of its two responses, part by part
  std::vector<bool> divides_;
  std::vector<std::uint32_t> held_ms_;
  std::vector<unsigned> events_;  // by rule: time words that are true for one step
  std::vector<bool> becomes_;     // … one of them is a BECOMES
  std::vector<bool> momentary_;   // … and the condition is true only when one of them is
  Inputs watched_;                // read by SAFETY rules
};

}  // namespace robosync::analysis
