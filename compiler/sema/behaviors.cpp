#include "compiler/sema/behaviors.hpp"

#include <algorithm>
#include <functional>

#include "compiler/ir/walk.hpp"
#include "compiler/source/sorting.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kMaxRules = UINT8_MAX;  // of one behaviour

}  // namespace

const BehaviorConfig* Behaviors::config_of(const ast::Behavior& behavior) const {
  const auto place = configs_.find(behavior.name.text);
  return place ? &robot_.behaviors[*place] : nullptr;
}

void Behaviors::add(const ast::Behavior& behavior, std::vector<ir::Rule> rules) {
  names_.insert(fold_name(behavior.name.text));
  const BehaviorConfig* config = config_of(behavior);
  const auto priority = priority_of(behavior, config);
  if (priority) claim(*priority);
  if (rules.size() > kMaxRules)
    diagnostics_
        .report(Code::E0407, behavior.name.shown() + " has " + std::to_string(rules.size()) +
                                 " rules; the limit is " + std::to_string(kMaxRules))
        .label(behavior.name.span);
  ir::Behavior result;
  result.priority = static_cast<std::int16_t>(priority ? priority->number : 0);
  result.name = behavior.name.text;
  result.rules = std::move(rules);
  if (config != nullptr) check_action(*config, result, behavior.name.span);
  if (result.rules.empty()) return;
  behaviors_.push_back(std::move(result));
  check_count(behavior.name.span);
}

void Behaviors::add_rule(ir::Rule rule, const std::optional<ast::Name>& priority, Span span) {
  const auto written = priority ? written_priority(*priority) : std::nullopt;
  if (written) claim(*written);
  ir::Behavior behavior;
  behavior.priority = written ? static_cast<std::int16_t>(written->number) : next_unnumbered_--;
  behavior.rules.push_back(std::move(rule));
  behaviors_.push_back(std::move(behavior));
  check_count(span);
}

void Behaviors::check_count(Span span) {
  if (behaviors_.size() == vm::kMaxBehaviors + 1) one_too_many_ = span;
}

void Behaviors::report_count() {
  if (!one_too_many_) return;
  diagnostics_
      .report(Code::E0407, "the program has " + std::to_string(behaviors_.size()) +
                               " behaviours; the limit is " + std::to_string(vm::kMaxBehaviors) +
                               " (a rule outside a BEHAVIOR counts as one)")
      .label(*one_too_many_, "this is one too many");
}

std::optional<Behaviors::Numbered> Behaviors::written_priority(const ast::Name& digits) {
  if (digits.text.empty()) return std::nullopt;
  const auto number = parse_decimal(digits.text);
  const bool good = number && number->decimals == 0 && number->mantissa >= 1 &&
                    number->mantissa <= vm::kMaxPriority;
  if (good) return Numbered{static_cast<int>(number->mantissa), digits.span, true};
  diagnostics_
      .report(Code::E0405,
              "a priority is a whole number from 1 to " + std::to_string(vm::kMaxPriority))
      .label(digits.span);
  return std::nullopt;
}

std::optional<Behaviors::Numbered> Behaviors::priority_of(const ast::Behavior& behavior,
                                                          const BehaviorConfig* config) {
  const bool in_json = config != nullptr && config->priority;
  if (!behavior.priority) {
    if (in_json) return Numbered{*config->priority, config->priority_span, false};
    diagnostics_.report(Code::E0405, "the behaviour " + behavior.name.shown() + " has no priority")
        .label(behavior.name.span)
        .helps("write `PRIORITY` and a number from 1 to 99 after its name");
    return std::nullopt;
  }
  const auto written = written_priority(*behavior.priority);
  if (written && in_json && written->number != *config->priority)
    diagnostics_
        .report(Code::E0408, behavior.name.shown() + " has priority " +
                                 std::to_string(written->number) + " here and " +
                                 std::to_string(*config->priority) + " in robot.json")
        .label(written->span)
        .label(config->priority_span, "the other priority", false)
        .helps("give it in one place only");
  return written;
}

void Behaviors::claim(const Numbered& priority) {
  const auto [first, added] = priorities_.emplace(priority.number, priority.span);
  if (!added) taken_.emplace_back(priority, first->second);
}

std::optional<int> Behaviors::next_free(int number) const {
  for (int distance = 1; distance < vm::kMaxPriority; ++distance)
    for (const int candidate : {number + distance, number - distance})
      if (candidate >= 1 && candidate <= vm::kMaxPriority && !priorities_.contains(candidate))
        return candidate;
  return std::nullopt;
}

void Behaviors::report_taken() {
  for (const auto& [priority, first] : taken_) {
    Diagnostic& d =
        diagnostics_
            .report(Code::E0401, "two behaviours have priority " + std::to_string(priority.number))
            .label(priority.span)
            .label(first, "first used here", false);
    const auto free = next_free(priority.number);
    if (!free) continue;
    d.helps("`" + std::to_string(*free) + "` is free")
        .fix(priority.span, std::to_string(*free), Applicability::likely);
    priorities_.emplace(*free, priority.span);  // so that it is not offered twice
  }
}

void Behaviors::check_action(const BehaviorConfig& config, const ir::Behavior& behavior,
                             Span name) {
  std::set<std::size_t> wanted;
  if (config.action) wanted.insert(*config.action);
  if (config.action_group)
    wanted.insert(robot_.groups[*config.action_group].members.begin(),
                  robot_.groups[*config.action_group].members.end());
  if (wanted.empty()) return;
  const auto is_wanted = [&](const ir::Command& command) {
    return std::any_of(command.actuators.begin(), command.actuators.end(),
                       [&](std::size_t actuator) { return wanted.contains(actuator); });
  };
  const auto commands_it = [&](const ir::Block& response) {
    return any_command(response, is_wanted);
  };
  for (const ir::Rule& rule : behavior.rules)
    if (commands_it(rule.then_response) || commands_it(rule.else_response)) return;
  diagnostics_.report(Code::W0215, "`" + behavior.name + "` never commands the actuator it is for")
      .label(name)
      .label(config.action_span, "its actuator", false);
}

std::vector<ir::Behavior> Behaviors::finish() {
  report_taken();
  report_count();
  for (const BehaviorConfig& config : robot_.behaviors)
    if (!names_.contains(fold_name(config.name.text)))
      diagnostics_.report(Code::W0216, "the program has no behaviour " + config.name.shown())
          .label(config.name.span);
  sort_stably(behaviors_, std::greater{}, &ir::Behavior::priority);
  return std::move(behaviors_);
}

}  // namespace robosync::compiler
