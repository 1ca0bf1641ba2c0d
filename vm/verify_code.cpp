// Verifier, part: the code of all rules, and that it does no more than the records declare.
#include <algorithm>

#include "vm/verify_object.hpp"

namespace robosync::vm {
namespace {

// The rules of one behaviour, which share a frame.
struct Rules {
  Rules(Verification& all, const Behavior& of)
      : verification(all), behavior(of), cells(of, count_watches(all.image, of)) {}

  Verification& verification;
  const Behavior& behavior;
  Cells cells;
  std::uint32_t actuators = 0;
};

bool check_condition(Rules& rules, const Rule& rule, std::uint32_t& cost) {
  if (rule.condition_length == 0) return true;
  const ObjectKind kind = rule.kind == RuleKind::every ? ObjectKind::period : ObjectKind::condition;
  ObjectFacts facts;
  if (!check_object(rules.verification, rules.behavior, rules.cells, kind,
                    {rule.condition_start, rule.condition_length}, facts))
    return false;
  cost += facts.cost;
  return true;
}

// Makes `cost` the response's cost if that is more.
bool check_response(Rules& rules, const Rule& rule, std::uint16_t index, std::uint32_t& cost) {
  if (index == kNoIndex) return true;
  const Response& response = rules.verification.image.responses[index];
  const ObjectKind kind = rule.kind == RuleKind::safety ? ObjectKind::safety : ObjectKind::response;
  ObjectFacts facts;
  if (!check_object(rules.verification, rules.behavior, rules.cells, kind,
                    {response.start, response.length}, facts))
    return false;
  if (facts.actuators != response.actuators)
    return rules.verification.refuse(Refusal::mask_differs, Section::responses, index);
  cost = std::max(cost, facts.cost);
  rules.actuators |= facts.actuators;
  return true;
}

bool check_rule(Rules& rules, const Rule& rule) {
  std::uint32_t cost = 0;
  if (!check_response(rules, rule, rule.then_response, cost) ||
      !check_response(rules, rule, rule.else_response, cost) || !check_condition(rules, rule, cost))
    return false;
  rules.verification.step_cost += cost;
  return true;
}

}  // namespace

// A response shared by several rules is checked for each: what its words mean depends on the frame
// of the behaviour that runs it. That cannot be made to take long: the words looked at are at most
// as many as the instructions that the board allows in one step (check_object).
bool check_code(Verification& verification) {
  const Image& image = verification.image;
  for (std::size_t b = 0; b < image.behaviors.size(); ++b) {
    const Behavior& behavior = image.behaviors[b];
    Rules rules(verification, behavior);
    for (std::size_t r = 0; r < behavior.rule_count; ++r)
      if (!check_rule(rules, image.rules[behavior.first_rule + r])) return false;
    if (rules.actuators != behavior.actuators)
      return verification.refuse(Refusal::mask_differs, Section::behaviors, b);
  }
  return true;
}

}  // namespace robosync::vm
