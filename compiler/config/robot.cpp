#include "compiler/config/robot.hpp"

#include <algorithm>
#include <utility>

#include "vm/drivers.hpp"

namespace robosync::compiler {
namespace {

template <typename List, typename Predicate>
auto find_in(const List& list, Predicate predicate) {
  const auto found = std::find_if(list.begin(), list.end(), predicate);
  return found == list.end() ? nullptr : &*found;
}

}  // namespace

void ChannelConfig::add_label(std::string label) {
  labels.push_back(std::move(label));
  max = static_cast<vm::Value>(labels.size() - 1) * vm::kScale;
}

std::optional<std::size_t> distance_of(const SensorConfig& encoder) {
  const auto& channels = encoder.channels;
  const auto* const found =
      find_in(channels, [](const ChannelConfig& one) { return one.input == vm::kDistanceInput; });
  if (found == nullptr) return std::nullopt;
  return static_cast<std::size_t>(found - channels.data());
}

bool ActuatorConfig::shows_numbers() const {
  return to_unit != nullptr && to_unit->dimension == vm::Dimension::number;
}

bool ActuatorConfig::moves() const {
  return find_in(verbs, [](const VerbConfig& verb) {
           return verb.action == vm::Action::move || verb.has(vm::Param::direction);
         }) != nullptr;
}

bool ActuatorConfig::moves_at_a_speed() const {
  return to_unit != nullptr && at_unit != nullptr && usual_speed != 0 && !vm::drives_wheels(driver);
}

const VerbConfig* ActuatorConfig::find_verb(std::string_view verb) const {
  return find_in(verbs, [&](const VerbConfig& v) { return same_name(v.name, verb); });
}

const WordConfig* ActuatorConfig::find_word(std::string_view word) const {
  return find_in(words, [&](const WordConfig& w) { return !w.text && same_name(w.name, word); });
}

const WordConfig* ActuatorConfig::find_text(std::string_view text) const {
  return find_in(words, [&](const WordConfig& w) { return w.text && w.name == text; });
}

bool VerbConfig::goes_with(const WordConfig& word) const {
  return has(word.param) &&
         (word.verbs.empty() ||
          find_in(word.verbs, [&](const std::string& verb) { return verb == name; }) != nullptr);
}

std::vector<std::string> ActuatorConfig::words_of(const VerbConfig& verb) const {
  std::vector<std::string> names;
  names.reserve(words.size());
  for (const WordConfig& word : words)
    if (!word.text && verb.goes_with(word)) names.push_back(word.name);
  return names;
}

WrittenUnits units_of(const Robot& robot) {
  WrittenUnits units;
  for (const SensorConfig& sensor : robot.sensors)
    for (const ChannelConfig& channel : sensor.channels)
      units.channels[sensor.name.text + "." + channel.name.text] = channel.unit;
  for (const ActuatorConfig& actuator : robot.actuators) {
    ActuatorUnits& own = units.actuators[actuator.name.text];
    own = {actuator.to_unit, actuator.at_unit};
    for (const VerbConfig& verb : actuator.verbs)
      if (verb.by_unit != nullptr) own.by[verb.name] = verb.by_unit;
  }
  return units;
}

}  // namespace robosync::compiler
