// Reads robot.json section by section; sensors and actuators have their own files.
#include "compiler/config/robot_reader.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <set>
#include <span>

#include "compiler/config/algorithms.hpp"
#include "compiler/config/boards.hpp"
#include "compiler/config/entries.hpp"
#include "compiler/config/fields.hpp"
#include "compiler/config/json_reader.hpp"
#include "compiler/config/values.hpp"
#include "compiler/config/wiring.hpp"
#include "compiler/diagnostics/nearest.hpp"
#include "compiler/source/utf8.hpp"

namespace robosync::compiler {
namespace {

// ---- groups

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
  if (!robot.complete) return;  // the mistake may be in its entry
  Diagnostic& d = diagnostics.report(Code::E0501, "there is no actuator `" + value.text + "`")
                      .label(value.span);
  if (!diagnostics.may_search(robot.actuators.size() + robot.groups.size())) return;
  const std::vector<std::string> candidates = actuator_names(robot, groups);
  if (!did_you_mean(d, value.span, value.text, candidates, "\"") && !candidates.empty())
    d.helps("actuators: " + list_names(candidates));
}

void read_group(const json::Member& member, const NameIndex& groups, const NameIndex& actuators,
                Robot& robot, Diagnostics& diagnostics) {
  GroupConfig group{{member.key, member.key_span}, {}};
  check_name(group.name, diagnostics);
  const std::string example = "\"" + member.key + "\": [\"left_arm\", \"right_arm\"]";
  if (!expect_kind(member.value, json::Kind::array, diagnostics, example)) return;
  if (member.value.items.empty())
    diagnostics.report(Code::E0205, "a group needs at least one member").label(member.value.span);
  std::set<std::size_t> members;
  for (const json::Value& item : member.value.items) {
    const auto name = read_text(item, diagnostics);
    if (!name) continue;
    const auto place = actuators.find(*name);
    if (!place && groups.find(*name)) {
      diagnostics.report(Code::E0205, "`" + *name + "` is a group, and a group has actuators only")
          .label(item.span)
          .helps("name its members instead");
    } else if (!place) {
      report_unknown_actuator(item, robot, false, diagnostics);
    } else if (!members.insert(*place).second) {
      diagnostics.report(Code::E0101, "`" + *name + "` is in this group twice").label(item.span);
    } else {
      group.members.push_back(*place);
      group.member_spans.push_back(item.span);
    }
  }
  robot.groups.push_back(std::move(group));
}

void read_groups(const json::Value& value, Robot& robot, Diagnostics& diagnostics) {
  if (!expect_kind(value, json::Kind::object, diagnostics,
                   "\"groups\": {\"arms\": [\"left_arm\", \"right_arm\"]}"))
    return;
  report_repeated_keys(value, diagnostics);
  const NameIndex actuators = index_of(robot.actuators);
  NameIndex groups;
  for (std::size_t g = 0; g < value.members.size(); ++g)
    groups.add(value.members[g].key, g);
  std::set<std::string_view> known;
  for (const json::Member& member : value.members) {
    const bool good = member.value.kind == json::Kind::array;
    const bool repeated = good ? !known.insert(member.key).second : known.contains(member.key);
    if (!repeated) read_group(member, groups, actuators, robot, diagnostics);
  }
}

// ---- behaviors

// Reads the entries of "behaviors", after actuators and groups.
class BehaviorReader {
public:
  BehaviorReader(Robot& robot, Diagnostics& diagnostics);
  // Adds an entry to the robot if it has a name.
  void read(const json::Value& value);

private:
  Robot& robot_;
  NameIndex actuators_, groups_;
  Diagnostics& diagnostics_;
};

BehaviorReader::BehaviorReader(Robot& robot, Diagnostics& diagnostics)
    : robot_(robot),
      actuators_(index_of(robot.actuators)),
      groups_(index_of(robot.groups)),
      diagnostics_(diagnostics) {}

void BehaviorReader::read(const json::Value& value) {
  Fields fields(value, Object::behavior, diagnostics_);
  const auto name = read_name(fields, "a behaviour", diagnostics_);
  if (!name) return;
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
}

// ---- scheduler, safety

// The limit of α: the largest whole number whose thousandths fit in a u16.
constexpr vm::Value kMaxAlpha = 65 * vm::kScale;

// Missing values get the defaults of the paper's example.
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

// ---- lints

void report_unknown_lint(const json::Member& member, Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (const Code code : all_codes())
    if (is_lint(code)) names.emplace_back(code_name(code));
  Diagnostic& d =
      diagnostics.report(Code::E0205, "`" + member.key + "` is not a lint").label(member.key_span);
  if (const auto near = nearest(member.key, names))
    d.helps("did you mean `" + *near + "`?");
  else
    d.helps("lints begin with W, such as `W0203`");
}

void read_lints(const json::Value& value, Robot& robot, Diagnostics& diagnostics) {
  if (!expect_kind(value, json::Kind::object, diagnostics)) return;
  report_repeated_keys(value, diagnostics);
  constexpr std::array<std::string_view, 3> kLevels = {"allow", "warn", "deny"};
  for (const json::Member& member : value.members) {
    const auto level = read_choice(member.value, kLevels, diagnostics);
    const auto known = find_lint(member.key);
    if (!known)
      report_unknown_lint(member, diagnostics);
    else if (level)
      robot.lints[*known] = static_cast<LintLevel>(*level);
  }
}

// ---- repeated names

using NamedList = std::vector<const Spelled*>;

bool check_repeated(const NamedList& names, Diagnostics& diagnostics) {
  NameIndex known;
  const std::size_t before = diagnostics.all().size();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (known.add(names[i]->text, i)) continue;
    const Spelled& name = *names[i];
    const Spelled& first = *names[*known.find(name.text)];
    Diagnostic& d = diagnostics.report(Code::E0101, "the name `" + name.text + "` is given twice")
                        .label(name.span)
                        .label(first.span, "first given here", false);
    if (first.text != name.text)
      d.helps("case and `_` make no difference: `" + first.text + "` is the same name");
  }
  return diagnostics.all().size() == before;
}

// `touch LEVEL` may be written touchLevel, so no other sensor may have that name.
void check_joined_names(const Robot& robot, Diagnostics& diagnostics) {
  const NameIndex sensors = index_of(robot.sensors);
  for (const SensorConfig& sensor : robot.sensors)
    for (const ChannelConfig& channel : sensor.channels) {
      const auto found = sensors.find(sensor.name.text + channel.name.text);
      if (!found) continue;
      const Spelled& other = robot.sensors[*found].name;
      diagnostics
          .report(Code::E0101, "`" + other.text + "` could also mean `" + sensor.name.text + " " +
                                   channel.name.text + "`")
          .label(other.span)
          .label(channel.name.span, "this channel", false);
    }
}

// False: a name of the program could mean either of two.
bool check_names(const Robot& robot, Diagnostics& diagnostics) {
  NamedList sensors;
  NamedList actuators;
  NamedList behaviors;
  for (const SensorConfig& sensor : robot.sensors)
    sensors.push_back(&sensor.name);
  for (const ActuatorConfig& actuator : robot.actuators)
    actuators.push_back(&actuator.name);
  for (const GroupConfig& group : robot.groups)
    actuators.push_back(&group.name);
  for (const BehaviorConfig& behavior : robot.behaviors)
    behaviors.push_back(&behavior.name);
  const bool sensors_differ = check_repeated(sensors, diagnostics);
  const bool actuators_differ = check_repeated(actuators, diagnostics);
  (void)check_repeated(behaviors, diagnostics);
  check_joined_names(robot, diagnostics);
  return sensors_differ && actuators_differ;
}

// ---- lists

// Applies `read` to each entry of the list `key`.
void for_each_entry(const Fields& fields, std::string_view key, Diagnostics& diagnostics,
                    const std::function<void(const json::Value&)>& read) {
  const auto* list = fields.find(key);
  const std::string example = "\"" + std::string(key) + "\": [{\"name\": \"…\"}]";
  if (list == nullptr || !expect_kind(*list, json::Kind::array, diagnostics, example)) return;
  for (const json::Value& entry : list->items)
    read(entry);
}

bool has_any(const Diagnostics& diagnostics, std::size_t from, std::span<const Code> codes) {
  const auto& all = diagnostics.all();
  return std::any_of(
      all.begin() + static_cast<std::ptrdiff_t>(from), all.end(),
      [&](const Diagnostic& one) { return std::ranges::find(codes, one.code) != codes.end(); });
}

// True if no report after the first `before` makes the program miss a name or use another unit.
bool names_and_units_are_known(const Diagnostics& diagnostics, std::size_t before) {
  constexpr std::array kFelt = {Code::E0202, Code::E0203, Code::E0204, Code::E0206,
                                Code::E0208, Code::E0209, Code::E0301, Code::E0303};
  return !has_any(diagnostics, before, kFelt);
}

// True if no name was reported that RSL cannot write or that is its word. The program cannot use such a name.
bool names_can_be_written(const Diagnostics& diagnostics, std::size_t before) {
  constexpr std::array kFelt = {Code::E0102, Code::E0103};
  return !has_any(diagnostics, before, kFelt);
}

// The robot's own name. It need not be one that RSL can write: a program does not use it.
std::string read_robot_name(const json::Value& value, Diagnostics& diagnostics) {
  const auto name = read_text(value, diagnostics);
  if (!name) return {};
  const std::size_t size = name->size();
  std::string wrong;
  if (size == 0 || name->front() == ' ' || name->back() == ' ')
    wrong = "a robot's name begins and ends with a letter or another visible character";
  else if (utf8::printable(*name) != *name)
    wrong = "a robot's name has no invisible characters, such as tabs and new lines";
  else if (size > vm::kMaxRobotName)
    wrong = "a robot's name is at most " + std::to_string(vm::kMaxRobotName) + " letters long";
  if (wrong.empty()) return *name;
  Diagnostic& d = diagnostics.report(Code::E0205, wrong).label(value.span);
  if (size > vm::kMaxRobotName)
    d.helps("make it " + std::to_string(size - vm::kMaxRobotName) +
            " shorter; a letter that is not English, such as ä, counts as two or more");
  return {};
}

}  // namespace

std::optional<Robot> read_robot(const SourceMap& sources, FileId file, Diagnostics& diagnostics,
                                const AlgorithmModules& modules) {
  const auto tree = json::read(sources, file, diagnostics);
  if (!tree) return std::nullopt;
  const std::size_t before = diagnostics.all().size();
  const Fields fields(*tree, Object::robot, diagnostics);
  Robot robot;
  if (const auto* name = fields.find("name")) robot.name = read_robot_name(*name, diagnostics);
  if (const auto* board = fields.find("board"))
    robot.board = read_choice(*board, board_names(), diagnostics);
  Board of_robot = board_for(robot.board);
  if (!robot.board)
    of_robot.named =
        fields.find("board") == nullptr ? Board::Named::not_at_all : Board::Named::wrongly;
  WiringReader wiring(std::move(of_robot), diagnostics);
  for_each_entry(fields, "sensors", diagnostics, [&](const json::Value& entry) {
    auto sensor = read_sensor(entry, wiring, diagnostics);
    if (sensor) robot.sensors.push_back(std::move(*sensor));
  });
  for_each_entry(fields, "actuators", diagnostics, [&](const json::Value& entry) {
    auto actuator = read_actuator(entry, robot.sensors, wiring, diagnostics);
    if (actuator) robot.actuators.push_back(std::move(*actuator));
  });
  wiring.report_pins_used_twice();
  if (const auto* pictures = fields.find("pictures")) read_pictures(*pictures, robot, diagnostics);
  robot.complete = names_and_units_are_known(diagnostics, before);
  if (const auto* groups = fields.find("groups")) read_groups(*groups, robot, diagnostics);
  BehaviorReader behaviors(robot, diagnostics);
  for_each_entry(fields, "behaviors", diagnostics,
                 [&](const json::Value& entry) { behaviors.read(entry); });
  bool all_usable = true;
  for_each_entry(fields, "algorithms", diagnostics, [&](const json::Value& entry) {
    all_usable =
        read_algorithm(entry, sources.file(file).name(), modules, robot, diagnostics) && all_usable;
  });
  if (const auto* scheduler = fields.find("scheduler"))
    robot.scheduler = read_scheduler(*scheduler, diagnostics);
  if (const auto* safety = fields.find("safety")) read_safety(*safety, robot, diagnostics);
  if (const auto* seed = fields.find("seed"))
    robot.seed =
        static_cast<std::uint32_t>(read_whole(*seed, 1, kMaxSeed, diagnostics).value_or(0));
  if (const auto* lints = fields.find("lints")) read_lints(*lints, robot, diagnostics);
  const bool names_differ = check_names(robot, diagnostics);
  robot.complete = names_differ && names_and_units_are_known(diagnostics, before) &&
                   names_can_be_written(diagnostics, before) && all_usable &&
                   (fields.find("board") == nullptr || robot.board.has_value());
  return robot;
}

}  // namespace robosync::compiler
