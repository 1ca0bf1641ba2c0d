#include "compiler/config/robot_reader.hpp"

#include <algorithm>
#include <functional>

#include "compiler/config/boards.hpp"
#include "compiler/config/entries.hpp"
#include "compiler/config/fields.hpp"
#include "compiler/config/json_reader.hpp"
#include "compiler/config/sections.hpp"
#include "compiler/config/wiring.hpp"

namespace robosync::compiler {
namespace {

using NamedList = std::vector<const Spelled*>;

void check_repeated(const NamedList& names, Diagnostics& diagnostics) {
  NameIndex known;
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
}

// `touch LEVEL` may be written touchLevel: that must not be another sensor's name.
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

void check_names(const Robot& robot, Diagnostics& diagnostics) {
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
  check_repeated(sensors, diagnostics);
  check_repeated(actuators, diagnostics);
  check_repeated(behaviors, diagnostics);
  check_joined_names(robot, diagnostics);
}

// Applies `read`, which says whether the entry could be used, to each entry of the list `key`.
void for_each_entry(const Fields& fields, std::string_view key, Robot& robot,
                    Diagnostics& diagnostics, const std::function<bool(const json::Value&)>& read) {
  const auto* list = fields.find(key);
  if (list == nullptr) return;
  if (!expect_kind(*list, json::Kind::array, diagnostics)) robot.complete = false;
  for (const json::Value& entry : list->items)
    robot.complete = read(entry) && robot.complete;
}

}  // namespace

std::optional<Robot> read_robot(const SourceMap& sources, FileId file, Diagnostics& diagnostics) {
  const auto tree = json::read(sources, file, diagnostics);
  if (!tree) return std::nullopt;
  const Fields fields(*tree, Object::robot, diagnostics);
  Robot robot;
  robot.complete = tree->kind == json::Kind::object;
  if (const auto* board = fields.find("board")) {
    robot.board = read_choice(*board, board_names(), diagnostics);
    robot.complete = robot.complete && robot.board.has_value();
  }
  WiringReader wiring(robot.board ? board_at(*robot.board) : default_board(), diagnostics);
  for_each_entry(fields, "sensors", robot, diagnostics, [&](const json::Value& entry) {
    auto sensor = read_sensor(entry, wiring, diagnostics);
    if (sensor) robot.sensors.push_back(std::move(*sensor));
    return sensor.has_value();
  });
  for_each_entry(fields, "actuators", robot, diagnostics, [&](const json::Value& entry) {
    auto actuator = read_actuator(entry, wiring, diagnostics);
    if (actuator) robot.actuators.push_back(std::move(*actuator));
    return actuator.has_value();
  });
  if (const auto* groups = fields.find("groups")) read_groups(*groups, robot, diagnostics);
  BehaviorReader behaviors(robot, diagnostics);
  for_each_entry(fields, "behaviors", robot, diagnostics,
                 [&](const json::Value& entry) { return behaviors.read(entry); });
  for_each_entry(fields, "algorithms", robot, diagnostics, [&](const json::Value& entry) {
    report_algorithm(entry, diagnostics);
    return true;
  });
  if (const auto* scheduler = fields.find("scheduler"))
    robot.scheduler = read_scheduler(*scheduler, diagnostics);
  if (const auto* safety = fields.find("safety")) read_safety(*safety, robot, diagnostics);
  if (const auto* seed = fields.find("seed"))
    robot.seed =
        static_cast<std::uint32_t>(read_whole(*seed, 1, kMaxSeed, diagnostics).value_or(0));
  if (const auto* lints = fields.find("lints")) read_lints(*lints, robot, diagnostics);
  check_names(robot, diagnostics);
  return robot;
}

}  // namespace robosync::compiler
