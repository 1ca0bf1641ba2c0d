// Finds the rules that make a step expensive, for messages about steps that cost too much.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "vm/cost.hpp"

namespace robosync::compiler {

struct CostlyRule {
  std::size_t rule = 0;  // its number
  vm::RuleCost cost;
};

// The three rules that cost most in a step, most expensive first. Empty if the verifier would refuse the code for any reason but
// its cost. `image` must be a view that vm::view_image() accepted.
[[nodiscard]] std::vector<CostlyRule> costly_rules(const vm::Image& image);

inline constexpr std::string_view kHelpForCostlyStep =
    "a REPEAT counts as often as it runs: repeat it less often, or put a WAIT in it so that "
    "the rest runs in a later step";

}  // namespace robosync::compiler
