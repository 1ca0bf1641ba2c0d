// See arbiter.hpp. Behaviours are numbered from the highest priority down; the verifier checks this.
#include "runtime-m4/layers/arbiter.hpp"

#include <algorithm>

#include "runtime-m4/policy/rules.hpp"

namespace robosync::layers {
namespace {

constexpr std::uint8_t kNobody = 0xFF;

}  // namespace

void Arbiter::start(std::span<const std::uint8_t> behavior_of, Memory& memory) {
  behavior_of_ = behavior_of;
  holdings_ = memory.take<policy::Part::holdings, Holding>();
  const auto words = memory.take<policy::Part::running, RuleSet::Word>();
  running_.start(part_of(words, policy::kRunningSets, 0));
  resting_.start(part_of(words, policy::kRunningSets, 1));
  won_.start(part_of(words, policy::kRunningSets, 2));
  thens_.start(part_of(words, policy::kRunningSets, 3));
  owned_ = 0;
  halted_ = 0;
}

bool Arbiter::may_take(const Claim& claim, unsigned from) const {
  return !won_now(from) && policy::may_take(claim.behavior, behavior_of_[from], claim.retries);
}

Decision Arbiter::decide_among_owners(const Claim& claim) const {
  if ((claim.actuators & halted_) != 0)
    return {.outcome = Outcome::loses, .owner = Decision::kHalter};
  std::uint8_t owner = kNobody;
  running_.each([&](unsigned rule) {
    if (rule == claim.rule || (holdings_[rule].actuators & claim.actuators) == 0) return;
    if (!may_take(claim, rule)) owner = std::min(owner, behavior_of_[rule]);
  });
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
  if (!resting_.empty()) resting_.erase(claim.rule);
  won_.insert(claim.rule);
  thens_.put(claim.rule, claim.side == Side::then);
  owned_ |= claim.actuators;
  holdings_[claim.rule] = Holding{.actuators = claim.actuators, .pending = 0};
}

}  // namespace robosync::layers
