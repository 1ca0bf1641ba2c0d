// The timing as a table and as JSON, with the same figures.
#include <fmt/format.h>

#include "rsc/json.hpp"
#include "rsc/names.hpp"
#include "rsc/timing.hpp"
#include "vm/verifier.hpp"

namespace robosync::tool {
namespace {

std::string percent(const Share& share) {
  return fmt::format("{:.1f} %",
                     100 * static_cast<double>(share.used) / static_cast<double>(share.limit));
}

std::string title(const BehaviorTiming& behavior) {
  if (behavior.priority == vm::kSafetyPriority) return "SAFETY rules";
  if (behavior.name.empty()) return "rule outside a BEHAVIOR";
  return fmt::format("BEHAVIOR {} PRIORITY {}", behavior.name, behavior.priority);
}

std::string rule_line(const RuleTiming& rule) {
  std::string response;
  if (rule.response_line != 0) {
    response = fmt::format("{:>8}  {:<4} line {}", rule.cost.worst_response(),
                           rule.else_is_worst ? "ELSE" : "DO", rule.response_line);
  }
  return fmt::format("{:>6}  {:<24}{:>10}  {:<24}{:>8}\n", rule.line,
                     word_of(kRuleKinds, rule.kind), rule.cost.condition, response,
                     rule.cost.step());
}

std::string steps_text(const Timing& timing) {
  std::string text = fmt::format("{:>6}  {:<24}{:>10}  {:<24}{:>8}\n", "line", "rule", "condition",
                                 "worst response", "step");
  for (const BehaviorTiming& behavior : timing.behaviors) {
    text += fmt::format("        {:<60}{:>8}\n", title(behavior), behavior.step);
    for (const RuleTiming& rule : behavior.rules)
      text += rule_line(rule);
  }
  return text + fmt::format("        {:<60}{:>8}\n", "step, in total", timing.step.used);
}

std::string threads_text(const Timing& timing) {
  std::string text =
      fmt::format("        {:<44}{:>8}{:>8}{:>8}\n", "thread", "frame", "stack", "bytes");
  for (const BehaviorTiming& behavior : timing.behaviors) {
    text += fmt::format("        {:<44}{:>8}{:>8}{:>8}\n", title(behavior), behavior.frame_bytes,
                        behavior.stack_bytes, behavior.frame_bytes + behavior.stack_bytes);
  }
  return text;
}

std::string sections_text(const Timing& timing) {
  std::string text = fmt::format("        {:<44}{:>8}{:>16}\n", "section", "records", "bytes");
  for (const SectionSize& size : timing.sections)
    text += fmt::format("        {:<44}{:>8}{:>16}\n", vm::describe(size.section), size.records,
                        size.bytes);
  return text;
}

std::string share_line(const Share& share) {
  return fmt::format("        {:<16}{:>8} of {:>6} {:<14}{:>8}\n", share.what, share.used,
                     share.limit, share.unit, percent(share));
}

Json rule_json(const RuleTiming& rule) {
  Json object{{"rule", rule.number},
              {"kind", word_of(kRuleKinds, rule.kind)},
              {"line", rule.line},
              {"condition", rule.cost.condition},
              {"do", rule.cost.then_response},
              {"else", rule.cost.else_response},
              {"step", rule.cost.step()},
              {"worst", nullptr}};
  if (rule.response_line != 0) {
    object["worst"] = {{"side", rule.else_is_worst ? "else" : "do"}, {"line", rule.response_line}};
  }
  return object;
}

Json behavior_json(const BehaviorTiming& behavior) {
  Json object{{"name", nullptr},
              {"priority", behavior.priority},
              {"step", behavior.step},
              {"frame_bytes", behavior.frame_bytes},
              {"stack_bytes", behavior.stack_bytes},
              {"machine_bytes", vm::kMachineBytes},
              {"rules", Json::array()}};
  if (!behavior.name.empty()) object["name"] = behavior.name;
  for (const RuleTiming& rule : behavior.rules)
    object["rules"].push_back(rule_json(rule));
  return object;
}

Json share_json(const Share& share) {
  Json object{{"what", share.what}, {"used", share.used}, {"limit", share.limit}};
  if (!share.unit.empty()) object["unit"] = share.unit;
  return object;
}

}  // namespace

std::string timing_text(const Timing& timing, const std::string& file) {
  std::string text = fmt::format(
      "{}: worst case in executed Cortex-M4 instructions of bytecode (not cycles)\n\n", file);
  text += steps_text(timing) + "\n" + threads_text(timing);
  text += fmt::format("        Each stack holds {} bytes of the bytecode machine.\n\n",
                      vm::kMachineBytes);
  text += sections_text(timing) + "\n";
  text += fmt::format("        {:<16}{:>8}    {:>6} {:<14}{:>8}\n", "the board", "taken", "has", "",
                      "share");
  text += share_line(timing.step);
  for (const Share& share : timing.memory)
    text += share_line(share);
  return text;
}

Json timing_json(const Timing& timing, const std::string& file) {
  Json object{{"file", file},
              {"step", share_json(timing.step)},
              {"behaviors", Json::array()},
              {"sections", Json::array()},
              {"memory", Json::array()}};
  for (const BehaviorTiming& behavior : timing.behaviors)
    object["behaviors"].push_back(behavior_json(behavior));
  for (const SectionSize& size : timing.sections) {
    object["sections"].push_back({{"section", vm::describe(size.section)},
                                  {"records", size.records},
                                  {"bytes", size.bytes}});
  }
  for (const Share& share : timing.memory)
    object["memory"].push_back(share_json(share));
  return object;
}

}  // namespace robosync::tool
