#include "compiler/config/sections.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>

#include "compiler/config/entries.hpp"
#include "compiler/config/fields.hpp"
#include "compiler/config/values.hpp"
#include "compiler/diagnostics/nearest.hpp"

namespace robosync::compiler {
namespace {

// Of α: what a u16 of thousandths holds, in whole numbers.
constexpr vm::Value kMaxAlpha = 65 * vm::kScale;

std::vector<std::string> actuator_names(const Robot& robot, bool groups) {
  std::vector<std::string> names;
  for (const ActuatorConfig& actuator : robot.actuators)
    names.push_back(actuator.name.text);
  if (groups)
    for (const GroupConfig& group : robot.groups)
      names.push_back(group.name.text);
  return names;
}

void report_unknown_actuator(const json::Value& value, const Robot& robot, bool groups,
                             Diagnostics& diagnostics) {
  Diagnostic& d = diagnostics.report(Code::E0501, "there is no actuator `" + value.text + "`")
                      .label(value.span);
  if (!diagnostics.may_search(robot.actuators.size() + robot.groups.size())) return;
  const std::vector<std::string> candidates = actuator_names(robot, groups);
  if (const auto near = nearest(value.text, candidates))
    d.helps("did you mean `" + *near + "`?").fix(value.span, "\"" + *near + "\"");
  else if (!candidates.empty())
    d.helps("actuators: " + list_names(candidates));
}

void read_group(const json::Member& member, const NameIndex& actuators, Robot& robot,
                Diagnostics& diagnostics) {
  GroupConfig group{{member.key, member.key_span}, {}};
  check_name(group.name, diagnostics);
  if (!expect_kind(member.value, json::Kind::array, diagnostics)) {
    robot.complete = false;
    return;
  }
  if (member.value.items.empty())
    diagnostics.report(Code::E0205, "a group has at least one member").label(member.value.span);
  std::set<std::size_t> members;
  for (const json::Value& item : member.value.items) {
    const auto name = read_text(item, diagnostics);
    if (!name) continue;
    const auto place = actuators.find(*name);
    if (!place) {
      report_unknown_actuator(item, robot, false, diagnostics);
    } else if (!members.insert(*place).second) {
      diagnostics.report(Code::E0101, "`" + *name + "` is in this group twice").label(item.span);
    } else {
      group.members.push_back(*place);
    }
  }
  robot.groups.push_back(std::move(group));
}

struct NamedCode {
  std::string_view name;
  Code code;
};
constexpr NamedCode kCodes[] = {
#define DIAGNOSTIC(code, level, title) {#code, Code::code},
#include "compiler/diagnostics/diagnostics.def"
#undef DIAGNOSTIC
};

bool is_lint(const NamedCode& entry) {
  return entry.name.front() == 'W';
}

void report_unknown_lint(const json::Member& member, Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (const NamedCode& entry : kCodes)
    if (is_lint(entry)) names.emplace_back(entry.name);
  Diagnostic& d =
      diagnostics.report(Code::E0205, "`" + member.key + "` is not a lint").label(member.key_span);
  if (const auto near = nearest(member.key, names))
    d.helps("did you mean `" + *near + "`?");
  else
    d.helps("lints begin with W, such as `W0203`");
}

}  // namespace

void read_groups(const json::Value& value, Robot& robot, Diagnostics& diagnostics) {
  if (!expect_kind(value, json::Kind::object, diagnostics)) {
    robot.complete = false;
    return;
  }
  report_repeated_keys(value, diagnostics);
  const NameIndex actuators = index_of(robot.actuators);
  std::set<std::string_view> known;
  for (const json::Member& member : value.members) {
    const bool good = member.value.kind == json::Kind::array;
    const bool repeated = good ? !known.insert(member.key).second : known.contains(member.key);
    if (!repeated) read_group(member, actuators, robot, diagnostics);
  }
}

BehaviorReader::BehaviorReader(Robot& robot, Diagnostics& diagnostics)
    : robot_(robot),
      actuators_(index_of(robot.actuators)),
      groups_(index_of(robot.groups)),
      diagnostics_(diagnostics) {}

bool BehaviorReader::read(const json::Value& value) {
  Fields fields(value, Object::behavior, diagnostics_);
  const auto name = read_name(fields, "a behaviour", diagnostics_);
  if (!name) return false;
  BehaviorConfig behavior;
  behavior.name = *name;
  if (const auto* priority = fields.find("priority")) {
    behavior.priority_span = priority->span;
    if (const auto number = read_whole(*priority, 1, vm::kMaxPriority, diagnostics_))
      behavior.priority = static_cast<int>(*number);
  }
  if (const auto* action = fields.find("action"); action && read_text(*action, diagnostics_)) {
    behavior.action_span = action->span;
    behavior.action = actuators_.find(action->text);
    behavior.action_group = groups_.find(action->text);
    if (!behavior.action && !behavior.action_group)
      report_unknown_actuator(*action, robot_, true, diagnostics_);
  }
  robot_.behaviors.push_back(std::move(behavior));
  return true;
}

SchedulerConfig read_scheduler(const json::Value& value, Diagnostics& diagnostics) {
  const Fields fields(value, Object::scheduler, diagnostics);
  SchedulerConfig scheduler;
  const auto out_of_range = [&](const json::Value& wrong, const std::string& range) {
    diagnostics.report(Code::E0205, "this must be from " + range).label(wrong.span);
  };
  if (const auto* alpha = fields.find("alpha"))
    if (const auto number =
            read_quantity(*alpha, canonical_unit(vm::Dimension::number), diagnostics)) {
      if (*number < 0 || *number > kMaxAlpha)
        out_of_range(*alpha, "0 to " + std::to_string(kMaxAlpha / vm::kScale));
      else
        scheduler.alpha = static_cast<std::uint16_t>(*number);
    }
  if (const auto* window = fields.find("window"))
    if (const auto time = read_milliseconds(*window, diagnostics)) {
      if (*time < vm::kMinAdaptationMs)
        out_of_range(*window, std::to_string(vm::kMinAdaptationMs) + " ms to 65535 ms");
      else
        scheduler.window_ms = *time;
    }
  if (const auto* cap = fields.find("cap"))
    if (const auto number = read_whole(*cap, 1, vm::kMaxPriority, diagnostics))
      scheduler.cap = static_cast<std::uint8_t>(*number);
  return scheduler;
}

void read_safety(const json::Value& value, Robot& robot, Diagnostics& diagnostics) {
  const Fields fields(value, Object::safety, diagnostics);
  if (const auto* start = fields.find("start"))
    robot.safety_start_ms = read_milliseconds(*start, diagnostics).value_or(kSafetyStartMs);
}

void report_algorithm(const json::Value& value, Diagnostics& diagnostics) {
  Fields fields(value, Object::algorithm, diagnostics);
  const auto name = read_name(fields, "an algorithm", diagnostics);
  if (!name) return;
  diagnostics
      .report(Code::W0214,
              "this version of rsc cannot load algorithms yet: `" + name->text + "` does nothing")
      .label(name->span);
}

void read_lints(const json::Value& value, Robot& robot, Diagnostics& diagnostics) {
  if (!expect_kind(value, json::Kind::object, diagnostics)) return;
  report_repeated_keys(value, diagnostics);
  constexpr std::array<std::string_view, 3> kLevels = {"allow", "warn", "deny"};
  for (const json::Member& member : value.members) {
    const auto level = read_choice(member.value, kLevels, diagnostics);
    const auto known = std::find_if(
        std::begin(kCodes), std::end(kCodes),
        [&](const NamedCode& entry) { return is_lint(entry) && entry.name == member.key; });
    if (known == std::end(kCodes))
      report_unknown_lint(member, diagnostics);
    else if (level)
      robot.lints[known->code] = static_cast<LintLevel>(*level);
  }
}

}  // namespace robosync::compiler
