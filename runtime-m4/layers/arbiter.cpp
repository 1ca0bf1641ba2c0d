// See arbiter.hpp. Behaviours are numbered from the highest priority down, as the verifier demands.
#include "runtime-m4/layers/arbiter.hpp"

#include <algorithm>

#include "runtime-m4/policy/rules.hpp"

namespace robosync::layers {
namespace {

constexpr std::uint8_t kNobody = 0xFF;

bool may_take(const Claim& claim, const Holding& from) {
  if (from.won_now) return false;
  return policy::may_take(claim.behavior, from.behavior, claim.retries);
}

}  // namespace

Decision decide(const Claim& claim, std::span<const Holding> holdings, const RuleSet& running,
                ActuatorMask halted) {
  Decision decision{.interrupted = {}, .wins = true, .owner = claim.behavior};
  const bool runs = running.has(claim.rule);
  if (runs && holdings[claim.rule].side == claim.side && !claim.restarting) {
    decision.wins = false;  // already running: the trigger is ignored
    return decision;
  }
  std::uint8_t owner = kNobody;
  if ((claim.actuators & halted) != 0) {
    decision.wins = false;
    owner = vm::kSafetyBehavior;
  }
  for (const unsigned rule : running) {
    const Holding& other = holdings[rule];
    if (rule == claim.rule || (other.actuators & claim.actuators) == 0) continue;
    if (may_take(claim, other)) {
      decision.interrupted.insert(rule);
    } else {
      decision.wins = false;
      owner = std::min(owner, other.behavior);
    }
  }
  if (!decision.wins) {
    decision.interrupted.clear();
    decision.owner = owner;
  }
  if (runs) decision.interrupted.insert(claim.rule);
  return decision;
}

}  // namespace robosync::layers
