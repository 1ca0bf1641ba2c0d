// See arbiter.hpp. Behaviours are numbered from the highest priority down, as the verifier demands.
#include "runtime-m4/layers/arbiter.hpp"

#include <algorithm>

namespace robosync::layers {
namespace {

constexpr std::uint8_t kNobody = 0xFF;
constexpr std::uint8_t kSafety = 0;  // number of the behaviour that holds the safety rules

bool may_take(const Claim& claim, const Holding& from) {
  if (from.won_now) return false;
  return claim.retries ? from.behavior > claim.behavior : from.behavior >= claim.behavior;
}

}  // namespace

Decision decide(const Claim& claim, std::span<const Holding> holdings, ActuatorMask halted) {
  Decision decision{.interrupted = 0, .wins = true, .owner = claim.behavior};
  const Holding& own = holdings[claim.rule];
  if (own.running && own.side == claim.side && !claim.restarting) {
    decision.wins = false;  // already running: the trigger is ignored
    return decision;
  }
  RuleMask taken = 0;
  std::uint8_t owner = kNobody;
  if ((claim.actuators & halted) != 0) {
    decision.wins = false;
    owner = kSafety;
  }
  for (unsigned rule = 0; rule < holdings.size(); ++rule) {
    const Holding& other = holdings[rule];
    if (!other.running || rule == claim.rule || (other.actuators & claim.actuators) == 0) continue;
    if (may_take(claim, other)) {
      taken |= bit<RuleMask>(rule);
    } else {
      decision.wins = false;
      owner = std::min(owner, other.behavior);
    }
  }
  if (decision.wins) {
    decision.interrupted = taken;
  } else {
    decision.owner = owner;
  }
  if (own.running) decision.interrupted |= bit<RuleMask>(claim.rule);
  return decision;
}

}  // namespace robosync::layers
