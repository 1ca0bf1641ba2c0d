// The event is not trusted. Promises a name, or a number with the word for what it counts.
#include "rsc/trace/event_reader.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "rsc/names.hpp"
#include "rsc/quantity.hpp"
#include "runtime-m4/policy/standing.hpp"

namespace robosync::tool {
namespace {

constexpr std::array kShapes = {
#define EVENT(name, number, subject, object, values, doc) \
  EventShape{link::EventKind::name, #name, About::subject, About::object, values},
#include "link/events.def"
#undef EVENT
};

const EventShape& shape_of(link::EventKind kind) {
  return *std::ranges::find(kShapes, kind, &EventShape::kind);  // decode_event() knows the kind
}

// Fills values into the {} places of a text; with too few values, places remain.
std::string filled_in(std::string_view text, std::span<const vm::Value> values) {
  std::string result;
  for (const vm::Value value : values) {
    const auto place = compiler::find_place(text);
    if (!place) break;
    result += text.substr(0, place->begin);
    result += compiler::shown_at(*place, value);
    text.remove_prefix(place->begin + place->size);
  }
  return result += text;
}

}  // namespace

std::string shown_word(std::string_view word) {
  return word.empty() ? "\"\"" : std::string(word);
}

vm::Dimension dimension_of_param(std::size_t param) {
  const bool is_time = param == static_cast<std::size_t>(vm::Param::over) ||
                       param == static_cast<std::size_t>(vm::Param::for_);
  return is_time ? vm::Dimension::duration : vm::Dimension::number;
}

EventReader::EventReader(const link::Event& event, const TraceNames& names)
    : event_(event), names_(names), shape_(shape_of(event.kind)) {}

std::span<const std::int32_t> EventReader::values() const {
  return std::span(event_.values)
      .first(std::min<std::size_t>(event_.value_count, event_.values.size()));
}

vm::Value EventReader::value(std::size_t index) const {
  return index < values().size() ? values()[index] : vm::kUnknown;
}

template <typename Record>
std::string EventReader::name_at(std::span<const Record> vm::Image::*section, std::size_t index,
                                 std::string_view what) const {
  if (const Record* const record = at(section, index)) {
    const std::string_view name = names_.image->string(record->name);
    if (!name.empty()) return std::string(name);
  }
  return fmt::format("{} {}", what, index);
}

// ---- rules and behaviours

const vm::Rule* EventReader::rule() const {
  return at(&vm::Image::rules, event_.subject);
}

const vm::Behavior* EventReader::behavior_with_rule() const {
  if (names_.image == nullptr) return nullptr;
  for (const vm::Behavior& behavior : names_.image->behaviors) {
    if (event_.subject >= behavior.first_rule &&
        event_.subject < behavior.first_rule + behavior.rule_count) {
      return &behavior;
    }
  }
  return nullptr;
}

std::string_view EventReader::behavior_of_rule() const {
  const vm::Behavior* const behavior = behavior_with_rule();
  return behavior == nullptr ? std::string_view() : names_.image->string(behavior->name);
}

bool EventReader::is_safety_rule() const {
  const vm::Behavior* const behavior = behavior_with_rule();
  return behavior != nullptr && behavior->priority == vm::kSafetyPriority;
}

bool EventReader::interrupts_itself() const {
  const vm::Behavior* const object = at(&vm::Image::behaviors, event_.object);
  return object != nullptr && object == behavior_with_rule();
}

bool EventReader::is_only_rule() const {
  const vm::Behavior* const behavior = behavior_with_rule();
  return behavior != nullptr && behavior->rule_count == 1;
}

std::string EventReader::rule_name() const {
  const vm::Rule* const found = rule();
  if (found == nullptr) return fmt::format("rule {}", event_.subject);
  const std::string place = place_of(event_.subject);
  if (is_safety_rule()) {
    const std::string name = safety_name();
    return fmt::format("safety rule {}{}at {}", name, name.empty() ? "" : " ", place);
  }
  const std::string_view behavior = behavior_of_rule();
  return behavior.empty() ? fmt::format("rule at {}", place)
                          : fmt::format("{}, rule at {}", behavior, place);
}

std::string EventReader::safety_name() const {
  return names_.origin != nullptr ? names_.origin->safety_name(event_.subject) : std::string();
}

std::string EventReader::place_of(std::size_t rule) const {
  if (names_.origin != nullptr && rule < names_.origin->rules.size() &&
      !names_.origin->rules[rule].empty()) {
    return names_.origin->rules[rule];
  }
  return fmt::format("line {}", names_.image->rules[rule].line);
}

// A rule outside a BEHAVIOR is a behaviour without a name, identified by its line.
std::string EventReader::behavior_name(std::uint16_t index) const {
  if (index == link::kStop) return "a person's stop";
  const vm::Behavior* const behavior = at(&vm::Image::behaviors, index);
  if (behavior == nullptr) return fmt::format("behaviour {}", index);
  if (behavior->priority == vm::kSafetyPriority) return "safety";
  const std::string_view name = names_.image->string(behavior->name);
  if (!name.empty()) return fmt::format("behaviour {}", name);
  const vm::Rule* const first = at(&vm::Image::rules, behavior->first_rule);
  return first != nullptr ? fmt::format("the rule at {}", place_of(behavior->first_rule))
                          : fmt::format("behaviour {}", index);
}

std::int16_t EventReader::base_priority() const {
  const vm::Behavior* const behavior = at(&vm::Image::behaviors, event_.subject);
  return behavior == nullptr ? std::int16_t{0} : behavior->priority;
}

// ---- other names

const vm::Sensor* EventReader::sensor() const {
  return at(&vm::Image::sensors, event_.subject);
}
std::string EventReader::sensor_name() const {
  if (shape_.subject == About::sensor)
    return name_at(&vm::Image::sensors, event_.subject, "sensor");
  const vm::Channel* const measured = channel();
  return measured == nullptr ? "?" : name_at(&vm::Image::sensors, measured->sensor, "sensor");
}
const vm::Channel* EventReader::channel() const {
  return at(&vm::Image::channels, event_.subject);
}
bool EventReader::is_made() const {
  const vm::Channel* const made = channel();
  const vm::Sensor* const sensor =
      made == nullptr ? nullptr : at(&vm::Image::sensors, made->sensor);
  return sensor != nullptr && sensor->driver == vm::DriverId::algorithm;
}
std::string EventReader::channel_name() const {
  return name_at(&vm::Image::channels, event_.subject, "channel");
}
std::string EventReader::variable_name() const {
  return name_at(&vm::Image::variables, event_.subject, "variable");
}
bool EventReader::is_signal() const {
  const vm::Variable* const variable = at(&vm::Image::variables, event_.subject);
  return variable != nullptr && variable->kind == vm::VariableKind::signal;
}
bool EventReader::is_timer() const {
  const vm::Variable* const variable = at(&vm::Image::variables, event_.subject);
  return variable != nullptr && variable->kind == vm::VariableKind::timer;
}
std::string EventReader::actuator_name() const {
  return name_at(&vm::Image::actuators, event_.subject, "actuator");
}
std::string EventReader::verb_name() const {
  return name_at(&vm::Image::verbs, event_.object, "verb");
}
// The text of a SAY may be empty.
std::optional<std::string> EventReader::written_word() const {
  if (value(0) < 0) return std::nullopt;
  const vm::WordEntry* const record = word();
  if (record == nullptr) return fmt::format("word {}", value(0));
  return std::string(names_.image->string(record->name));
}
const vm::WordEntry* EventReader::word() const {
  return value(0) < 0 ? nullptr : at(&vm::Image::words, static_cast<std::size_t>(value(0)));
}
bool EventReader::is_said(std::size_t param) const {
  return std::ranges::find(vm::kTextParams, static_cast<vm::Param>(param)) !=
             vm::kTextParams.end() &&
         compiler::find_place(written_word().value_or("")).has_value();
}
std::optional<std::string> EventReader::word_name() const {
  const std::optional<std::string> written = written_word();
  if (!written) return std::nullopt;
  std::vector<vm::Value> values;
  for_each_param([&](std::size_t param, vm::Value given) {
    if (is_said(param)) values.push_back(given);
  });
  return filled_in(*written, values);
}
bool EventReader::is_carried_out() const {
  bool known = event_.kind == link::EventKind::command;
  for_each_param([&](std::size_t, vm::Value given) { known = known && given != vm::kUnknown; });
  return known;
}
std::string EventReader::thread_name() const {
  return event_.subject < names_.threads.size() ? text_of(names_.threads[event_.subject].name)
                                                : fmt::format("thread {}", event_.subject);
}

std::string EventReader::thread_words() const {
  std::string name = thread_name();
  if (event_.subject >= names_.threads.size()) return name;
  switch (static_cast<policy::Category>(names_.threads[event_.subject].category)) {
    case policy::Category::sensor:
      return "sensor " + name;
    case policy::Category::algorithm:
      return "algorithm " + name;
    case policy::Category::control:
      return "actuator " + name;
    case policy::Category::behavior:  // rules outside a BEHAVIOR have no name of their own
      return name == "rule" ? "a rule outside a BEHAVIOR" : "behaviour " + name;
    default:
      return name;
  }
}

bool names_thread(const link::Event& event) {
  return shape_of(event.kind).subject == About::thread;
}

std::string EventReader::text() const {
  if (names_.image == nullptr) return fmt::format("text {}", event_.subject);
  return filled_in(names_.image->string(event_.subject), values());
}

// ---- values

std::vector<EventReader::Duration> EventReader::durations() const {
  if (event_.kind == link::EventKind::set && meaning().dimension == vm::Dimension::duration)
    return {{}};
  std::string text;
  std::vector<std::size_t> filled;  // the values of its places
  if (event_.kind == link::EventKind::command) {
    text = written_word().value_or("");
    std::size_t next = 2;
    for_each_param([&](std::size_t param, vm::Value) {
      if (is_said(param)) filled.push_back(next);
      ++next;
    });
  } else if (shape_.subject == About::string && names_.image != nullptr) {
    text = names_.image->string(event_.subject);
    for (std::size_t i = 0; i < values().size(); ++i)
      filled.push_back(i);
  }
  std::vector<Duration> durations;
  std::string_view rest = text;
  for (std::size_t i = 0; i < filled.size(); ++i) {
    const auto place = compiler::find_place(rest);
    if (!place) break;
    if (place->unit != nullptr && place->unit->dimension == vm::Dimension::duration)
      durations.push_back({filled[i], i});
    rest.remove_prefix(place->begin + place->size);
  }
  return durations;
}

Meaning EventReader::meaning() const {
  Meaning meaning;
  if (shape_.subject == About::channel) {
    const vm::Channel* const channel = at(&vm::Image::channels, event_.subject);
    if (channel != nullptr)
      meaning = {channel->dimension, channel->first_label, channel->label_count, nullptr};
  } else if (shape_.subject == About::variable) {
    const vm::Variable* const variable = at(&vm::Image::variables, event_.subject);
    if (variable != nullptr)
      meaning = {variable->dimension, variable->first_label, variable->label_count, nullptr};
  }
  meaning.unit = written_unit(meaning.dimension);
  return meaning;
}

// The unit of the subject (a channel or variable), if the source is known and gives one of
// `dimension`.
const compiler::Unit* EventReader::written_unit(vm::Dimension dimension) const {
  if (names_.origin == nullptr) return nullptr;
  const bool channel = shape_.subject == About::channel;
  const auto& units = channel ? names_.origin->units.channels : names_.origin->units.variables;
  const auto found = units.find(channel ? sensor_name() + "." + channel_name() : variable_name());
  const bool good = found != units.end() && found->second != nullptr;
  return good && found->second->dimension == dimension ? found->second : nullptr;
}

std::string_view EventReader::label(const Meaning& meaning, vm::Value value) const {
  if (value < 0 || value % vm::kScale != 0 || value / vm::kScale >= meaning.label_count) return {};
  const auto number = static_cast<std::size_t>(value / vm::kScale);
  const std::uint16_t* const offset = at(&vm::Image::labels, meaning.first_label + number);
  return offset == nullptr ? std::string_view() : names_.image->string(*offset);
}

std::string EventReader::shown(vm::Value value) const {
  const Meaning means = meaning();
  const std::string_view word = label(means, value);
  if (!word.empty()) return std::string(word);
  if (means.unit == nullptr || value == vm::kUnknown)
    return format_quantity(value, means.dimension);
  return compiler::format_value(value, *means.unit);
}

// The speed of a MOTION is a share of the written one, not a speed of its actuators.
const compiler::Unit* EventReader::unit_of(vm::Param param) const {
  const vm::Verb* const verb = at(&vm::Image::verbs, event_.object);
  if (param == vm::Param::at && verb != nullptr && verb->action == vm::Action::perform)
    return &compiler::canonical_unit(vm::Dimension::percent);
  if (names_.origin == nullptr) return nullptr;
  const auto& actuators = names_.origin->units.actuators;
  const auto found = actuators.find(actuator_name());
  if (found == actuators.end()) return nullptr;
  if (param == vm::Param::at) return found->second.at;
  if (param != vm::Param::to && param != vm::Param::by) return nullptr;
  const auto own = found->second.by.find(verb_name());
  const bool is_own = param == vm::Param::by && own != found->second.by.end();
  return is_own ? own->second : found->second.to;
}

std::string EventReader::shown(std::size_t param, vm::Value value) const {
  const compiler::Unit* const unit = unit_of(static_cast<vm::Param>(param));
  return unit == nullptr || value == vm::kUnknown
             ? format_quantity(value, dimension_of_param(param))
             : compiler::format_value(value, *unit);
}

}  // namespace robosync::tool
