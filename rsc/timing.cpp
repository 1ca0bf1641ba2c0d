// May assume a verified image, so every index in it is valid.
#include "rsc/timing.hpp"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "compiler/codegen/costly_rules.hpp"
#include "compiler/source/sorting.hpp"
#include "rsc/program.hpp"

namespace robosync::tool {
namespace {

std::vector<vm::RuleCost> costs_of(const vm::Image& image) {
  std::vector<vm::RuleCost> costs(image.rules.size());
  // It has been verified, so this cannot fail.
  if (!vm::rule_costs(image, costs)) costs.assign(costs.size(), {});
  return costs;
}

RuleTiming rule_timing(const vm::Image& image, std::size_t number, const vm::RuleCost& cost) {
  const vm::Rule& rule = image.rules[number];
  RuleTiming timing{number, rule.kind, rule.line, cost, cost.else_response > cost.then_response, 0};
  const std::uint16_t worst = timing.else_is_worst ? rule.else_response : rule.then_response;
  if (worst != vm::kNoIndex) {
    timing.response_line = source_line(image, vm::Section::code, image.responses[worst].start);
  }
  return timing;
}

BehaviorTiming behavior_timing(const vm::Image& image, const vm::Behavior& behavior,
                               const std::vector<vm::RuleCost>& costs) {
  BehaviorTiming timing;
  timing.name = image.string(behavior.name);
  timing.priority = behavior.priority;
  timing.frame_bytes = behavior.cells * sizeof(vm::Value);
  if (behavior.priority != vm::kSafetyPriority) timing.stack_bytes = policy::kBehaviorStack;
  for (std::size_t r = behavior.first_rule; r < behavior.first_rule + 0U + behavior.rule_count;
       ++r) {
    timing.rules.push_back(rule_timing(image, r, costs[r]));
    timing.step += costs[r].step();
  }
  compiler::sort_stably(timing.rules, {}, &RuleTiming::line);
  return timing;
}

// Without source lines: rsc upload leaves them out.
std::vector<SectionSize> uploaded_sections(const vm::Image& image) {
  std::vector<SectionSize> sizes = section_sizes(image);
  std::erase_if(sizes,
                [](const SectionSize& size) { return size.section == vm::Section::source_lines; });
  return sizes;
}

template <typename Record, typename SizeOf>
std::size_t sum(const Record& records, SizeOf size_of) {
  std::size_t all = 0;
  for (const auto& record : records)
    all += size_of(record);
  return all;
}

// By consumer, and in total.
std::vector<Share> memory_of(const policy::Needs& needs, const policy::BoardMemory& board) {
  std::vector<Share> memory;
  const auto shares = policy::shares_of(needs);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const auto whose = static_cast<policy::Whose>(i);
    if (whose == policy::Whose::algorithms && shares[i] == 0) continue;  // few robots have any
    memory.push_back({name_of(whose), "bytes", shares[i], board.arena_bytes});
  }
  memory.push_back({"memory", "bytes", needs.total, board.arena_bytes});
  return memory;
}

}  // namespace

int cap_of(const vm::Image& image) {
  return image.adaptations.empty() ? 0 : image.adaptations[0].cap;
}

Timing timing_of(const vm::Image& image, const policy::BoardMemory& board) {
  const std::vector<vm::RuleCost> costs = costs_of(image);
  Timing timing;
  for (const vm::Behavior& behavior : image.behaviors)
    if (behavior.rule_count > 0)
      timing.behaviors.push_back(behavior_timing(image, behavior, costs));
  compiler::sort_stably(timing.behaviors, {},
                        [](const BehaviorTiming& behavior) { return behavior.rules[0].line; });
  timing.step = {"step", "instructions", sum(costs, std::mem_fn(&vm::RuleCost::step)),
                 board.step_budget};
  timing.sections = uploaded_sections(image);
  timing.memory = memory_of(needs_on_board(image, board), board);
  return timing;
}

std::string too_costly_text(const vm::Image& image, std::uint32_t budget) {
  std::string text = fmt::format(
      "a step costs up to {} instructions, the board allows {}; the rules that cost most:",
      image.header->step_cost, budget);
  for (const compiler::CostlyRule& costly : compiler::costly_rules(image)) {
    const RuleTiming rule = rule_timing(image, costly.rule, costly.cost);
    text += fmt::format("\n  line {}: {} instructions", rule.line, rule.cost.step());
    if (rule.response_line != 0) {
      text += fmt::format(", {} of them in its {} (line {})", rule.cost.worst_response(),
                          rule.else_is_worst ? "ELSE" : "DO", rule.response_line);
    }
  }
  return text + fmt::format("\n  {}", compiler::kHelpForCostlyStep);
}

std::string refusal_text(const vm::Image& image, const vm::Verdict& verdict,
                         const policy::BoardMemory& board) {
  if (verdict.refusal == vm::Refusal::too_costly) return too_costly_text(image, board.step_budget);
  if (verdict.refusal == vm::Refusal::no_room)
    return no_room_text(needs_on_board(image, board), board);
  return describe_refusal(verdict, source_line(image, verdict.section, verdict.index));
}

}  // namespace robosync::tool
