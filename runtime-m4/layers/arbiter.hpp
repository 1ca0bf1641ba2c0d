// Who gets the actuators. Pure: what is decided depends on the arguments only.
//
// Claims of a step are served from the highest priority down, inside a behaviour in file order;
// that is the order of the rules in the image. What users are told of it: docs/language.md
// (RESTARTING and WAITING). In detail:
// * Claims of one step come at the same time, so none is "later": what was won in this step is not
//   lost in it. Of two rules of one behaviour that trigger together, the earlier in the file wins.
// * A claim that is tried again takes nothing from its own behaviour: only a trigger does.
// * Choosing the other side of a WHEN/ELSE ends the running one, even when the new side loses. So
//   does starting again (RESTARTING).
// * What safety has halted nobody gets; the claim loses to the behaviour that holds the safety
//   rules.
#pragma once

#include <cstdint>
#include <span>

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
  bool restarting = false;  // if it runs already on that side, it starts again
  bool retries = false;     // it did not trigger now, but wants to run since earlier
};

// What a rule has while its response runs. A table of these, by rule, and the set of those that run
// are all there is to know of ownership.
struct Holding {
  ActuatorBits actuators = 0;
  ActuatorBits pending = 0;  // of these, the ones with commands not yet done
  std::uint8_t behavior = 0;
  Side side : 1 = Side::then;
  bool won_now : 1 = false;  // in this step
};

struct Decision {
  RuleSet interrupted;  // running rules that end because of this claim
  bool wins = false;
  std::uint8_t owner = 0;  // if it does not win: the behaviour in its way, of the highest priority
};

[[nodiscard]] Decision decide(const Claim& claim, std::span<const Holding> holdings,
                              const RuleSet& running, ActuatorMask halted = 0);

}  // namespace robosync::layers
