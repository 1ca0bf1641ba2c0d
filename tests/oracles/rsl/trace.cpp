#include "tests/oracles/rsl/trace.hpp"

#include <array>
#include <cmath>
#include <ostream>

#include <nlohmann/json.hpp>

#include "compiler/units/units.hpp"
#include "tests/oracles/rsl/response.hpp"

namespace robosync::oracle {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kParamKeys = {"to", "by", "at", "over", "for", "times", "direction", "item"};

Json number(Number value) {
  if (!value) return nullptr;
  if (*value % 1000 == 0) return *value / 1000;
  return static_cast<double>(*value) / 1000;
}

Json line(Millis now, const char* event) {
  return {{"t_us", now * 1000}, {"event", event}};
}

// Does the parameter say a value of a text, when the text has places for some?
bool is_said(vm::Param param) {
  return param == vm::Param::by || param == vm::Param::times || param == vm::Param::direction;
}

// A number with a word is that word.
void add_value(Json& object, Number value, const std::vector<std::string>& labels,
               vm::Dimension dimension) {
  const bool word =
      value && *value % 1000 == 0 && *value / 1000 < static_cast<std::int64_t>(labels.size());
  if (word && *value >= 0) {
    object["value"] = labels[static_cast<std::size_t>(*value / 1000)];
    return;
  }
  object["value"] = number(value);
  const auto unit = compiler::canonical_unit(dimension).spelling;
  if (!unit.empty()) object["unit"] = unit;
}

}  // namespace

void Trace::channel(const char* event, compiler::ChannelRef channel, std::optional<Number> value) {
  const compiler::SensorConfig& sensor = robot_.sensors[channel.sensor];
  const compiler::ChannelConfig& config = sensor.channels[channel.channel];
  Json object = line(now_, event);
  object["sensor"] = sensor.name.text;
  object["channel"] = config.name.text;
  if (value) add_value(object, *value, config.labels, config.unit->dimension);
  out_ << object << "\n";
}

void Trace::variable(std::size_t variable, Number value) {
  const compiler::ir::Variable& config = program_.variables[variable];
  Json object = line(now_, "set");
  object["variable"] = config.name;
  const bool restarted = config.kind == vm::VariableKind::timer;
  add_value(object, restarted ? Number(0) : value, config.labels, config.dimension);
  out_ << object << "\n";
}

void Trace::rule(const char* event, const compiler::ir::Rule& rule,
                 const compiler::ir::Behavior* behavior, std::optional<bool> side,
                 const std::string& by) {
  Json object = line(now_, event);
  if (behavior != nullptr && !behavior->name.empty()) object["behavior"] = behavior->name;
  object["line"] = rule.line;
  if (!by.empty()) object["by"] = by;
  if (side) object["side"] = *side ? "DO" : "ELSE";
  out_ << object << "\n";
}

void Trace::actuator(const char* event, std::size_t actuator) {
  Json object = line(now_, event);
  object["actuator"] = robot_.actuators[actuator].name.text;
  out_ << object << "\n";
}

void Trace::command(std::size_t actuator, const Order& order) {
  Json object = line(now_, "command");
  object["actuator"] = robot_.actuators[actuator].name.text;
  object["verb"] = order.command->verb.name;
  const auto& own = order.command->word;
  const std::string word = own ? own->name : "";
  const bool has_places =
      word.find('{') != std::string::npos && word.find('}') != std::string::npos;
  std::vector<Number> said;
  for (const auto& [param, value] : order.given)
    if (has_places && is_said(param)) said.push_back(value);
  if (own) object["word"] = filled_in(word, said);
  for (const auto& [param, value] : order.given)
    if (has_places && is_said(param))
      object["values"].push_back(number(value));
    else
      object[kParamKeys.at(static_cast<std::size_t>(param))] = number(value);
  out_ << object << "\n";
}

void Trace::text(const char* event, const std::string& text, const std::vector<Number>& values) {
  Json object = line(now_, event);
  object["text"] = text;
  object["values"] = Json::array();
  for (const Number& value : values)
    object["values"].push_back(number(value));
  out_ << object << "\n";
}

}  // namespace robosync::oracle
