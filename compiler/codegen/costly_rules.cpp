#include "compiler/codegen/costly_rules.hpp"

#include <algorithm>
#include <functional>

#include "compiler/source/sorting.hpp"

namespace robosync::compiler {

std::vector<CostlyRule> costly_rules(const vm::Image& image) {
  constexpr std::size_t kShown = 3;
  std::vector<vm::RuleCost> costs(image.rules.size());
  std::vector<CostlyRule> rules;
  if (!vm::rule_costs(image, costs)) return rules;
  for (std::size_t r = 0; r < costs.size(); ++r)
    rules.push_back({r, costs[r]});
  sort_stably(rules, std::greater{}, [](const CostlyRule& rule) { return rule.cost.step(); });
  rules.resize(std::min(rules.size(), kShown));
  return rules;
}

}  // namespace robosync::compiler
