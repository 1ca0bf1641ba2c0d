// Trace events as JSON. Promises that everything an event carries is there, whatever its numbers.
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "compiler/units/units.hpp"
#include "rsc/trace/event_reader.hpp"
#include "rsc/trace/trace_format.hpp"
#include "vm/drivers.hpp"

namespace robosync::tool {
namespace {

using link::EventKind;

// FOR is `for_` in the list because `for` is a word of C++.
constexpr std::array<std::string_view, EventReader::kParamCount> kParamKeys = {
#define PARAM(name, spelling, doc) #name,
#include "rsc/json.hpp"
#include "vm/params.def"
#undef PARAM
};

std::string key_of_param(std::size_t param) {
  const std::string_view key = kParamKeys.at(param);
  return std::string(key.ends_with('_') ? key.substr(0, key.size() - 1) : key);
}

// Thousandths as a plain JSON number: 2, 0.5.
Json json_number(vm::Value value) {
  if (value == vm::kUnknown) return nullptr;
  if (value % vm::kScale == 0) return value / vm::kScale;
  return static_cast<double>(value) / vm::kScale;
}

void add_rule(Json& object, const EventReader& reader) {
  object["rule"] = reader.event().subject;
  const vm::Rule* const rule = reader.rule();
  if (rule == nullptr) return;
  if (const std::string_view behavior = reader.behavior_of_rule(); !behavior.empty()) {
    object["behavior"] = behavior;
  }
  if (const std::string safety = reader.safety_name(); !safety.empty()) object["safety"] = safety;
  object["line"] = rule->line;
}

void add_device(Json& object, const EventReader& reader) {
  object["sensor"] = reader.sensor_name();
  const vm::Sensor* const sensor = reader.sensor();
  if (sensor == nullptr) return;
  if (vm::is_by_echo(sensor->driver)) {
    object["trigger"] = sensor->bus;
    object["echo"] = sensor->address;
    return;
  }
  if (vm::is_analog(sensor->driver) || vm::counts_edges(sensor->driver)) {
    object["pin"] = sensor->address;
    return;
  }
  if (vm::is_of_board(sensor->driver)) return;
  object["bus"] = sensor->bus;
  if (vm::is_on_spi(sensor->driver)) {
    object["pin"] = sensor->address;
    return;
  }
  object["address"] = fmt::format("0x{:02x}", sensor->address);
}

void add_subject(Json& object, const EventReader& reader) {
  switch (reader.shape().subject) {
    case About::sensor:
      add_device(object, reader);
      break;
    case About::channel:
      object["sensor"] = reader.sensor_name();
      object["channel"] = reader.channel_name();
      break;
    case About::variable:
      object["variable"] = reader.variable_name();
      break;
    case About::rule:
      add_rule(object, reader);
      break;
    case About::behavior:
      object["behavior"] = reader.behavior_name(reader.event().subject);
      object["base"] = reader.base_priority();
      break;
    case About::actuator:
      object["actuator"] = reader.actuator_name();
      break;
    case About::thread:
      object["thread"] = reader.thread_name();
      break;
    case About::string:
      object["text"] = reader.text();
      break;
    case About::none:
    case About::verb:
    case About::word:
    case About::refusal:
      break;  // no event is about these
  }
}

void add_object(Json& object, const EventReader& reader) {
  if (reader.shape().object == About::verb) object["verb"] = reader.verb_name();
  if (reader.shape().object == About::behavior) {
    object["by"] = reader.behavior_name(reader.event().object);
  }
}

void add_value(Json& object, const EventReader& reader) {
  // The board stores the time of a RESTART; the program then reads 0 from the TIMER.
  const bool restarted = reader.shape().subject == About::variable && reader.is_timer();
  const vm::Value value = restarted ? 0 : reader.value(0);
  const Meaning meaning = reader.meaning();
  if (const std::string_view label = reader.label(meaning, value); !label.empty()) {
    object["value"] = label;
    return;
  }
  object["value"] = json_number(value);
  const std::string_view unit = compiler::canonical_unit(meaning.dimension).spelling;
  if (!unit.empty()) object["unit"] = unit;
}

void add_command(Json& object, const EventReader& reader) {
  if (const auto word = reader.word_name()) object["word"] = *word;
  reader.for_each_param([&](std::size_t param, vm::Value given) {
    if (reader.is_said(param))
      object["values"].push_back(json_number(given));
    else
      object[key_of_param(param)] = json_number(given);
  });
}

void add_values(Json& object, const EventReader& reader) {
  const std::string_view values = reader.shape().values;
  if (reader.event().kind == EventKind::command) {
    add_command(object, reader);
  } else if (values == "value") {
    add_value(object, reader);
  } else if (values == "side") {
    object["side"] = reader.value(0) == 0 ? "ELSE" : "DO";
  } else if (values == "args") {
    object["values"] = Json::array();
    for (const vm::Value value : reader.values())
      object["values"].push_back(json_number(value));
  } else if (!values.empty()) {
    object[std::string(values)] = reader.value(0);  // a plain count
  }
}

}  // namespace

std::string trace_json(const link::Event& event, const TraceNames& names) {
  const EventReader reader(event, names);
  Json object;
  object["t_us"] = event.time_us;
  object["step"] = event.step;
  object["event"] = reader.shape().name;
  add_subject(object, reader);
  add_object(object, reader);
  add_values(object, reader);
  return json_text(object);
}

}  // namespace robosync::tool
