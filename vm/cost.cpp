#include "vm/cost.hpp"

#include "vm/verify_object.hpp"

namespace robosync::vm {

bool rule_costs(const Image& image, std::span<RuleCost> costs) {
  Limits limits;
  limits.step_cost = UINT32_MAX;
  limits.frame_cells = limits.timer_words = limits.samples = UINT16_MAX;
  Verification verification{image, limits};
  if (costs.size() != image.rules.size() || !check_records(verification)) return false;
  for (const Behavior& behavior : image.behaviors) {
    Frame frame(verification, behavior);
    for (std::size_t r = behavior.first_rule; r < behavior.first_rule + 0U + behavior.rule_count;
         ++r)
      if (!check_rule(frame, image.rules[r], costs[r] = {})) return false;
  }
  return true;
}

}  // namespace robosync::vm
