// Who has the actuators, and who gets them. What is decided depends on nothing but what stands here
// and the claim.
//
// Claims of a step are served from the highest priority down, inside a behaviour in file order;
// that is the order of the rules in the image. What users are told of it: docs/language.md
// (RESTARTING and WAITING). In detail:
// * Claims of one step come at the same time, so none is "later": what was won in this step is not
//   lost in it. Of two rules of one behaviour that trigger together, the earlier in the file wins.
// * A claim that is tried again takes nothing from its own behaviour: only a trigger does.
// * Choosing the other side of a WHEN/ELSE ends the running one, even when the new side loses. So
//   does starting again (RESTARTING).
// * A WHILE that has done a round keeps what it has until its condition ends: it rests, and its next
//   claim begins another round.
// * What is halted nobody gets; the claim loses to no behaviour, but to who has halted it.
#pragma once

#include <cstdint>
#include <span>

#include "runtime-m4/layers/memory.hpp"
#include "runtime-m4/layers/messages.hpp"
#include "runtime-m4/layers/rule_set.hpp"

namespace robosync::layers {

enum class Side : std::uint8_t { otherwise, then };  // the number is the `side` of trace events

// A rule triggered and wants its response to run.
struct Claim {
  std::uint16_t rule;
  std::uint8_t behavior;
  Side side;
  ActuatorMask actuators;   // all its response can ever use; it gets all or none
  bool restarting = false;  // if it works already on that side, it starts again
  bool retries = false;     // it did not trigger now, but wants to run since earlier
};

// What a rule has while its response runs.
struct Holding {
  ActuatorMask actuators = 0;
  ActuatorMask pending = 0;  // of these, the ones with commands not yet done
};

enum class Outcome : std::uint8_t {
  wins,
  loses,
  ignored,  // it runs already: nothing changes
};
struct Decision {
  static constexpr std::uint8_t kHalter = 0xFE;  // who has halted an actuator

  Outcome outcome = Outcome::wins;
  // If it does not win: the behaviour in its way, of the highest priority, or kHalter.
  std::uint8_t owner = 0;

  bool wins() const { return outcome == Outcome::wins; }
};

class Arbiter {
public:
  // behavior_of: by rule.
  void start(std::span<const std::uint8_t> behavior_of, Memory& memory);

  // What is halted, from now on.
  void note_halted(ActuatorMask halted) { halted_ = halted; }
  ActuatorMask halted() const { return halted_; }
  // The step is over: what was won in it may be lost in the next one.
  void end_step() { won_.clear(); }

  // --- read by the behaviours' threads as well ---

  // It takes nothing from anybody, as most claims: so it wins, and ends nobody.
  [[gnu::always_inline]] bool is_free(const Claim& claim) const {
    return has_all_free(claim) && !works(claim.rule);
  }
  [[nodiscard]] bool wins(const Claim& claim) const {
    return is_free(claim) || decide(claim).wins();
  }
  [[nodiscard]] Decision decide(const Claim& claim) const {
    const bool again = works(claim.rule) && side(claim.rule) == claim.side;
    if (again && !claim.restarting) return {.outcome = Outcome::ignored, .owner = claim.behavior};
    if (has_all_free(claim)) [[likely]]
      return {};
    return decide_among_owners(claim);
  }
  // Does the response of `rule`, which runs, end by a claim that was decided so?
  [[nodiscard]] bool ends(const Claim& claim, const Decision& decision, unsigned rule) const;

  // The claim has won, and who ended by it is gone.
  void give(const Claim& claim);
  // The response of `rule`, which runs, is over.
  void end(unsigned rule) {
    owned_ &= ~holdings_[rule].actuators;
    running_.erase(rule);
  }

  // A round of its is over, and it keeps its actuators for the next one.
  void rest(unsigned rule) { resting_.insert(rule); }

  const RuleSet& running() const { return running_; }  // resting ones too
  [[gnu::always_inline]] bool runs(unsigned rule) const { return running_.has(rule); }
  bool rests(unsigned rule) const { return runs(rule) && resting_.has(rule); }
  [[gnu::always_inline]] bool works(unsigned rule) const {
    return runs(rule) && !resting_.has(rule);
  }
  // Of one that runs: did it win in this step, and which side?
  bool won_now(unsigned rule) const { return won_.has(rule); }
  Side side(unsigned rule) const { return thens_.has(rule) ? Side::then : Side::otherwise; }
  Holding& holding(unsigned rule) { return holdings_[rule]; }
  const Holding& holding(unsigned rule) const { return holdings_[rule]; }
  ActuatorMask owned() const { return owned_; }  // by all that run; each has one owner

private:
  [[gnu::always_inline]] bool has_all_free(const Claim& claim) const {
    return (claim.actuators & (owned_ | halted_)) == 0;
  }
  Decision decide_among_owners(const Claim& claim) const;
  bool may_take(const Claim& claim, unsigned from) const;

  std::span<const std::uint8_t> behavior_of_;
  std::span<Holding> holdings_;
  RuleSet running_;  // their responses run, or wait
  // Of these, the others may be in as well:
  RuleSet resting_;  // a WHILE between two rounds, of which it keeps the actuators
  RuleSet won_;      // in this step
  RuleSet thens_;    // their DO runs, and not their ELSE
  ActuatorMask owned_ = 0;
  ActuatorMask halted_ = 0;
};

}  // namespace robosync::layers
