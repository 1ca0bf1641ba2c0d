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

void Arbiter::start(Memory& memory) {
  holdings_ = memory.take<policy::Part::holdings, Holding>();
  running_.start(memory.take<policy::Part::running, RuleSet::Word>());
  owned_ = 0;
  halted_ = 0;
}

void Arbiter::end_step() {
  for (const unsigned rule : running_)
    holdings_[rule].won_now = false;
}

Decision Arbiter::decide_among_owners(const Claim& claim) const {
  std::uint8_t owner = kNobody;
  if ((claim.actuators & halted_) != 0) owner = vm::kSafetyBehavior;
  for (const unsigned rule : running_) {
    const Holding& other = holdings_[rule];
    if (rule == claim.rule || (other.actuators & claim.actuators) == 0) continue;
    if (!may_take(claim, other)) owner = std::min(owner, other.behavior);
  }
  if (owner == kNobody) return {};
  return {.outcome = Outcome::loses, .owner = owner};
}

bool Arbiter::ends(const Claim& claim, const Decision& decision, unsigned rule) const {
  if (decision.outcome == Outcome::ignored) return false;
  if (rule == claim.rule) return works(rule);
  return decision.wins() && (holdings_[rule].actuators & claim.actuators) != 0;
}

void Arbiter::give(const Claim& claim) {
  running_.insert(claim.rule);
  owned_ |= claim.actuators;
  holdings_[claim.rule] = Holding{.actuators = claim.actuators,
                                  .pending = 0,
                                  .behavior = claim.behavior,
                                  .side = claim.side,
                                  .won_now = true};
}

}  // namespace robosync::layers
