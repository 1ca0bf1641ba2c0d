// Which rules hold the actuators, and which get them. A decision depends only on the state kept here
// and on the claim.
//
// Claims of a step are served from the highest priority down, and in file order inside a behaviour;
// that is the order of the rules in the image. docs/language.md explains it to users
// (RESTARTING and WAITING). In detail:
// * Claims of one step are simultaneous, so none is "later": what was won in this step is not
//   lost in it. If two rules of one behaviour trigger together, the earlier in the file wins.
// * A claim that is tried again takes nothing from its own behaviour: only a trigger does.
// * Choosing the other side of a WHEN/ELSE ends the running one, even if the new side loses. So
//   does starting again (RESTARTING).
// * A WHILE that has done a round keeps its actuators until its condition ends: it rests, and its next
//   claim begins another round.
// * No claim gets a halted actuator. Such a claim loses not to a behaviour but to whatever halted the actuator.
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
  ActuatorMask actuators;   // all that its response can ever use; it gets all or none
  bool restarting = false;  // if that side is already running, start it again
  bool retries = false;     // it did not trigger now, but has wanted to run since earlier
};

// What a rule holds while its response runs.
struct Holding {
  ActuatorMask actuators = 0;
  ActuatorMask pending = 0;  // of these, the ones with commands not yet done
};

enum class Outcome : std::uint8_t {
  wins,
  loses,
  ignored,  // it is running already: nothing changes
};
struct Decision {
  static constexpr std::uint8_t kHalter = 0xFE;  // whatever has halted an actuator

  Outcome outcome = Outcome::wins;
  // If it does not win: the highest-priority behaviour in its way, or kHalter.
  std::uint8_t owner = 0;

  bool wins() const { return outcome == Outcome::wins; }
};

class Arbiter {
public:
  // behavior_of: indexed by rule.
  void start(std::span<const std::uint8_t> behavior_of, Memory& memory);

  // The halted actuators, from now on.
  void note_halted(ActuatorMask halted) { halted_ = halted; }
  ActuatorMask halted() const { return halted_; }
  // The step is over: what was won in it may be lost in the next one.
  void end_step() { won_.clear(); }

  // --- read by the behaviours' threads as well ---

  // It takes nothing from anybody, like most claims: so it wins, and ends nothing.
  [[gnu::always_inline]] bool is_free(const Claim& claim) const {
    return is_free(claim.actuators) && !works(claim.rule);
  }
  // Nobody holds one of them.
  [[gnu::always_inline]] bool is_free(ActuatorMask actuators) const {
    return (actuators & (owned_ | halted_)) == 0;
  }
  // A trigger of `rule` for this side certainly wins: it takes nothing but from the rule's other side. False: see decide().
  [[gnu::always_inline]] bool surely_wins(unsigned rule, Side side, ActuatorMask actuators) const {
    return is_free_for(rule, actuators) && !works_again(rule, side);
  }
  [[nodiscard]] bool wins(const Claim& claim) const {
    return is_free(claim) || decide(claim).wins();
  }
  [[nodiscard]] Decision decide(const Claim& claim) const {
    if (works_again(claim.rule, claim.side) && !claim.restarting)
      return {.outcome = Outcome::ignored, .owner = claim.behavior};
    if (is_free_for(claim.rule, claim.actuators)) [[likely]]
      return {};
    return decide_among_owners(claim);
  }
  // Does a claim with this decision end the running response of `rule`?
  [[nodiscard]] bool ends(const Claim& claim, const Decision& decision, unsigned rule) const;

  // The claim has won, and the responses that it ends are gone.
  void give(const Claim& claim);
  // The running response of `rule` is over.
  void end(unsigned rule) {
    owned_ &= ~holdings_[rule].actuators;
    running_.erase(rule);
  }

  // A round of a WHILE is over, and it keeps its actuators for the next one.
  void rest(unsigned rule) { resting_.insert(rule); }

  const RuleSet& running() const { return running_; }  // includes those that rest
  [[gnu::always_inline]] bool runs(unsigned rule) const { return running_.has(rule); }
  bool rests(unsigned rule) const { return runs(rule) && resting_.has(rule); }
  [[gnu::always_inline]] bool works(unsigned rule) const {
    return runs(rule) && !resting_.has(rule);
  }
  // Of a running rule: did it win in this step, and which side is running?
  bool won_now(unsigned rule) const { return won_.has(rule); }
  Side side(unsigned rule) const { return thens_.has(rule) ? Side::then : Side::otherwise; }
  Holding& holding(unsigned rule) { return holdings_[rule]; }
  const Holding& holding(unsigned rule) const { return holdings_[rule]; }
  ActuatorMask owned() const { return owned_; }  // by all running rules; each has one owner

private:
  // Nobody else holds one of them: each actuator has one owner.
  [[gnu::always_inline]] bool is_free_for(unsigned rule, ActuatorMask actuators) const {
    const ActuatorMask mine = runs(rule) ? holdings_[rule].actuators : 0;
    return (actuators & ((owned_ & ~mine) | halted_)) == 0;
  }
  // That side of it is at work already.
  [[gnu::always_inline]] bool works_again(unsigned rule, Side side) const {
    return works(rule) && this->side(rule) == side;
  }
  Decision decide_among_owners(const Claim& claim) const;
  bool may_take(const Claim& claim, unsigned from) const;

  std::span<const std::uint8_t> behavior_of_;
  std::span<Holding> holdings_;
  RuleSet running_;  // their responses run or wait
  // Subsets of these:
  RuleSet resting_;  // WHILEs between two rounds, keeping their actuators
  RuleSet won_;      // in this step
  RuleSet thens_;    // their DO is running, not their ELSE
  ActuatorMask owned_ = 0;
  ActuatorMask halted_ = 0;
};

}  // namespace robosync::layers
