#include "compiler/config/robot_vocabulary.hpp"

#include <algorithm>

#include "compiler/config/devices.hpp"
#include "compiler/syntax/keywords.hpp"

namespace robosync::compiler {

namespace {

// A round value in the middle of a range, as a person would choose it: 200cm, not 201cm, for 2 … 400. A small value if there is
// no range.
std::string middle(vm::Value low, vm::Value high, const Unit& unit) {
  constexpr vm::Value some = 3 * vm::kScale;
  if (low == vm::kValueMin || high == vm::kValueMax) return format_value(some, unit);
  const std::int64_t exact = (std::int64_t{low} + high) / 2;
  std::int64_t round = exact;
  for (std::int64_t power = 1; power <= std::abs(exact); power *= 10)
    round = exact / power * power;
  return format_value(low <= round && round <= high ? round : exact, unit);
}

std::string middle(const ChannelConfig& channel) {
  return middle(channel.min, channel.max, *channel.unit);
}

std::string written(const SensorConfig& sensor, const ChannelConfig& channel) {
  if (channel.truth && sensor.channels.size() == 1) return sensor.name.text;
  return sensor.name.text + " " + channel.name.text;
}

// As written in RSL: a word that could mean something else is in quotes.
std::string word(const std::string& label) {
  const bool plain = std::ranges::all_of(label, [](char c) {
    return c == '_' || ('0' <= c && c <= '9') || ('A' <= c && c <= 'Z') || ('a' <= c && c <= 'z');
  });
  return plain && !is_keyword(label) ? label : "\"" + label + "\"";
}

std::string condition(const SensorConfig& sensor, const ChannelConfig& channel) {
  std::string name = written(sensor, channel);
  if (channel.truth) return name;
  if (!channel.labels.empty()) return name + " IS " + word(channel.labels.back());
  return name + " > " + middle(channel);
}

std::string reading(const SensorConfig& sensor, const ChannelConfig& channel) {
  const std::string name = written(sensor, channel) + " = ";
  if (channel.truth) return name + "TRUE";
  if (!channel.labels.empty()) return name + "\"" + channel.labels.back() + "\"";
  return name + middle(channel);
}

std::string said(Vocabulary::Part part, const SensorConfig& sensor, const ChannelConfig& channel) {
  const bool number = channel.labels.empty();
  switch (part) {
    case Vocabulary::Part::condition:
      return condition(sensor, channel);
    case Vocabulary::Part::reading:
      return reading(sensor, channel);
    case Vocabulary::Part::channel:
      return number ? written(sensor, channel) : "";
    case Vocabulary::Part::threshold:
      return number ? middle(channel) : "";
    default:
      return {};
  }
}

// The device's first word for this parameter, with a space before it.
std::string word_for(const ActuatorConfig& actuator, const VerbConfig& verb, vm::Param param) {
  const auto found = std::ranges::find_if(actuator.words, [&](const WordConfig& one) {
    return one.param == param && !one.text && verb.goes_with(one);
  });
  return found == actuator.words.end() ? "" : " " + found->name;
}

std::string text_for(const ActuatorConfig& actuator, const VerbConfig& verb) {
  if (verb.texts == Texts::any) return " \"Hello\"";
  if (verb.texts == Texts::none) return "";
  const auto found = std::ranges::find_if(actuator.words, &WordConfig::text);
  return found == actuator.words.end() ? "" : " \"" + found->name + "\"";
}

// The arguments of the verb: a text, a picture, a direction or a place, and how fast.
std::string arguments(const ActuatorConfig& actuator, const VerbConfig& verb, bool places) {
  if (std::string text = text_for(actuator, verb); !text.empty()) return text;
  if (std::string item = word_for(actuator, verb, vm::Param::item); !item.empty()) return item;
  std::string where = word_for(actuator, verb, vm::Param::direction);
  if ((places || where.empty()) && verb.has(vm::Param::to) && actuator.to_unit != nullptr)
    where = " TO " + middle(actuator.min, actuator.max, *actuator.to_unit);
  if (where.starts_with(" TO") && gets_power(actuator)) return where;  // which also says how fast
  return where + word_for(actuator, verb, vm::Param::at);
}

bool is_called(const Spelled& own, std::string_view name) {
  return name.empty() || same_name(own.text, name);
}

}  // namespace

std::vector<std::string_view> RobotVocabulary::reserved_names() const {
  std::vector<std::string_view> names;
  const auto add = [&names](const auto& parts) {
    for (const auto& part : parts)
      if (!may_name_a_part(part.name.text)) names.push_back(part.name.text);
  };
  add(robot_.sensors);
  add(robot_.actuators);
  add(robot_.groups);
  return names;
}

std::string RobotVocabulary::part(Part part, std::string_view name) const {
  for (const SensorConfig& sensor : robot_.sensors)
    if (is_called(sensor.name, name))
      for (const ChannelConfig& channel : sensor.channels)
        if (std::string text = said(part, sensor, channel); !text.empty()) return text;
  return of_actuator(part, name);
}

std::string RobotVocabulary::of_actuator(Part part, std::string_view name) const {
  for (const ActuatorConfig& actuator : robot_.actuators) {
    if (!is_called(actuator.name, name)) continue;
    if (part == Part::actuator) return actuator.name.text;
    if (part == Part::speed_limit && actuator.at_unit != nullptr)
      return actuator.name.text + " SPEED TO " +
             format_value(std::int64_t{30} * vm::kScale, *actuator.at_unit);
    if (part != Part::followed || actuator.to_unit == nullptr || actuator.shows_numbers() ||
        actuator.drive)
      continue;
    return actuator.name.text + " TO " + middle(actuator.min, actuator.max, *actuator.to_unit);
  }
  return {};
}

std::string RobotVocabulary::command(std::string_view verb, std::string_view name,
                                     bool places) const {
  const auto belongs = [&](std::size_t actuator, const GroupConfig& group) {
    return same_name(group.name.text, name) &&
           std::ranges::find(group.members, actuator) != group.members.end();
  };
  for (std::size_t i = 0; i < robot_.actuators.size(); ++i) {
    const ActuatorConfig& actuator = robot_.actuators[i];
    const auto group = std::ranges::find_if(
        robot_.groups, [&](const GroupConfig& one) { return belongs(i, one); });
    const bool of_group = group != robot_.groups.end();
    if (!of_group && !is_called(actuator.name, name)) continue;
    for (const VerbConfig& one : actuator.verbs) {
      if (!verb.empty() && !same_name(one.name, verb)) continue;
      const std::string how = arguments(actuator, one, places);
      // Not every actuator of a group may reach that place.
      const bool all = of_group && !how.starts_with(" TO ");
      return one.name + " " + (all ? group->name.text : actuator.name.text) + how;
    }
  }
  return {};
}

}  // namespace robosync::compiler
