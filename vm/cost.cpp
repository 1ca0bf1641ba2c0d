#include "vm/cost.hpp"

#include "vm/verify_object.hpp"

namespace robosync::vm {
namespace {

// The objects of a behaviour's rules, in the order in which the verifier takes them: what an object
// may do depends on those before it.
class Objects {
public:
  Objects(Verification& verification, const Behavior& behavior)
      : verification_(verification),
        behavior_(behavior),
        cells_(behavior, count_watches(verification.image, behavior)) {}

  bool look_at(const Rule& rule, RuleCost& cost) {
    const ObjectKind body =
        rule.kind == RuleKind::safety ? ObjectKind::safety : ObjectKind::response;
    const ObjectKind condition =
        rule.kind == RuleKind::every ? ObjectKind::period : ObjectKind::condition;
    return take(body, range_of(rule.then_response), cost.then_response) &&
           take(body, range_of(rule.else_response), cost.else_response) &&
           take(condition, {rule.condition_start, rule.condition_length}, cost.condition);
  }

private:
  [[nodiscard]] CodeRange range_of(std::uint16_t response) const {
    if (response == kNoIndex) return {0, 0};
    const Response& body = verification_.image.responses[response];
    return {body.start, body.length};
  }

  bool take(ObjectKind kind, CodeRange range, std::uint32_t& cost) {
    if (range.length == 0) return true;
    ObjectFacts facts;
    if (!check_object(verification_, behavior_, cells_, kind, range, facts)) return false;
    cost = facts.cost;
    return true;
  }

  Verification& verification_;
  const Behavior& behavior_;
  Cells cells_;
};

}  // namespace

bool rule_costs(const Image& image, std::span<RuleCost> costs) {
  Limits limits;
  limits.step_cost = UINT32_MAX;
  limits.frame_cells = limits.timer_words = limits.samples = UINT16_MAX;
  Verification verification{image, limits};
  if (costs.size() != image.rules.size() || !check_records(verification)) return false;
  for (const Behavior& behavior : image.behaviors) {
    Objects objects(verification, behavior);
    for (std::size_t r = behavior.first_rule; r < behavior.first_rule + 0U + behavior.rule_count;
         ++r)
      if (!objects.look_at(image.rules[r], costs[r] = {})) return false;
  }
  return true;
}

}  // namespace robosync::vm
