// See recorder.hpp.
#include "rsc/timeline/recorder.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/units/units.hpp"
#include "rsc/json.hpp"
#include "rsc/timeline/pictures.hpp"
#include "rsc/timeline/thresholds.hpp"
#include "vm/drivers.hpp"

namespace robosync::tool {
namespace {

using link::EventKind;

Json unit_of(const std::map<std::string, const compiler::Unit*>& written, const std::string& name,
             vm::Dimension dimension) {
  const auto found = written.find(name);
  const compiler::Unit& unit = found != written.end() && found->second != nullptr
                                   ? *found->second
                                   : compiler::canonical_unit(dimension);
  return {{"name", unit.spelling},
          {"factor", unit.factor},
          {"offset", unit.offset},
          {"divisor", unit.divisor}};
}

Json value_of(vm::Value value) {
  return value == vm::kUnknown ? Json(nullptr) : Json(value);
}

// Excludes the hidden variables of NEXT and ANY, whose names have a space, and TIMERs and SIGNALs, which have no readable
// value.
bool is_shown(const vm::Image& image, const vm::Variable& variable) {
  return variable.kind != vm::VariableKind::signal && variable.kind != vm::VariableKind::timer &&
         image.string(variable.name).find(' ') == std::string_view::npos;
}

Json labels_of(const vm::Image& image, std::size_t first, std::size_t count) {
  Json labels = Json::array();
  for (std::size_t i = 0; i < count; ++i)
    labels.push_back(image.string(image.labels[first + i]));
  return labels;
}

// A position, a power or a picture stays when its command is done, except with FOR. Power 0 is nothing, a number 0 is. A drive ends
// its own.
bool has_lasting_effect(const link::Event& event, const TraceNames& names) {
  const EventReader reader(event, names);
  if (names.image == nullptr || event.object >= names.image->verbs.size()) return false;
  if (vm::drives_wheels(names.image->actuators[event.subject].driver)) return false;
  const vm::Action action = names.image->verbs[event.object].action;
  if (action != vm::Action::set && action != vm::Action::move && action != vm::Action::follow)
    return false;
  const bool power = !shows_pictures(names.image->actuators[event.subject]);
  bool lasts = true;
  reader.for_each_param([&](std::size_t param, vm::Value value) {
    const auto which = static_cast<vm::Param>(param);
    if (which == vm::Param::for_) lasts = false;
    if (action == vm::Action::set && power && which == vm::Param::to && value == 0) lasts = false;
  });
  return lasts;
}

// Events shown as messages.
bool is_message(EventKind kind) {
  switch (kind) {
    case EventKind::log:
    case EventKind::alert:
    case EventKind::fault:
    case EventKind::deadline:
    case EventKind::lowered:
    case EventKind::overrun:
    case EventKind::zero_divide:
    case EventKind::silent:
    case EventKind::answers:
    case EventKind::blocked:
      return true;
    default:
      return false;
  }
}

}  // namespace

TimelineRecorder::TimelineRecorder(const Program& program, const TraceNames& names)
    : image_(program.image()),
      names_(names),
      owners_(image_.actuators.size()),
      moves_(image_.actuators.size()),
      halted_(image_.actuators.size()),
      lasts_(image_.actuators.size()) {
  page_["begin_us"] = 0;
  for (const char* list : {"behaviors", "signals", "actuators", "safety", "denied", "messages"})
    page_[list] = Json::array();
  for (const vm::Behavior& behavior : image_.behaviors)
    page_["behaviors"].push_back(behavior.name == vm::kNoIndex ? "" : image_.string(behavior.name));
  for (const vm::Actuator& actuator : image_.actuators)
    page_["actuators"].push_back({{"name", image_.string(actuator.name)},
                                  {"bars", Json::array()},
                                  {"halts", Json::array()}});
  page_["pictures"] = Json::array();
  add_rules();
  add_signals();
}

void TimelineRecorder::add_rules() {
  page_["rules"] = Json::array();
  for (std::size_t i = 0; i < image_.rules.size(); ++i) {
    const std::string place =
        names_.origin != nullptr && i < names_.origin->rules.size() ? names_.origin->rules[i] : "";
    const std::uint16_t line = image_.rules[i].line;
    const bool elsewhere = !place.empty();
    std::string name = elsewhere ? place : "line " + std::to_string(line);
    const std::string safety = names_.origin != nullptr ? names_.origin->safety_name(i) : "";
    if (!safety.empty()) name += " (" + safety + ")";
    page_["rules"].push_back({{"name", name}, {"line", elsewhere ? 0 : line}});
  }
}

// Channels first, then variables, as the image numbers its inputs.
void TimelineRecorder::add_signals() {
  const compiler::WrittenUnits none;
  const compiler::WrittenUnits& written = names_.origin == nullptr ? none : names_.origin->units;
  for (const vm::Channel& channel : image_.channels) {
    const std::string sensor(image_.string(image_.sensors[channel.sensor].name));
    const std::string name(image_.string(channel.name));
    page_["signals"].push_back(
        {{"group", "sensor"},
         {"name", fmt::format("{} {}", sensor, name)},
         {"unit", unit_of(written.channels, fmt::format("{}.{}", sensor, name), channel.dimension)},
         {"labels", labels_of(image_, channel.first_label, channel.label_count)},
         {"points", Json::array()},
         {"thresholds", Json::array()}});
  }
  for (const vm::Variable& variable : image_.variables) {
    const std::string name(image_.string(variable.name));
    page_["signals"].push_back(
        {{"group", is_shown(image_, variable) ? "variable" : "hidden"},
         {"name", name},
         {"unit", unit_of(written.variables, name, variable.dimension)},
         {"labels", labels_of(image_, variable.first_label, variable.label_count)},
         {"points", Json::array({Json::array({0, value_of(variable.initial)})})},
         {"thresholds", Json::array()}});
  }
  for (const Threshold& one : thresholds_of(image_)) {
    const bool band = one.rule == Threshold::kNoRule;
    page_["signals"][one.input]["thresholds"].push_back(
        {{"value", one.value},
         {"text", one.text},
         {"rule", band ? Json(nullptr) : Json(one.rule)}});
  }
}

int TimelineRecorder::behavior_of(std::size_t rule) const {
  for (std::size_t i = 0; i < image_.behaviors.size(); ++i) {
    const vm::Behavior& behavior = image_.behaviors[i];
    if (rule >= behavior.first_rule &&
        rule < std::size_t{behavior.first_rule} + behavior.rule_count)
      return static_cast<int>(i);
  }
  return -1;
}

// When watching starts in the middle of a run, the initial values are not known.
void TimelineRecorder::begin(const link::Event& first) {
  if (first.kind == EventKind::activated) return;
  page_["begin_us"] = first.time_us;
  for (Json& signal : page_["signals"])
    signal["points"].clear();
}

void TimelineRecorder::see(const link::Event& event) {
  const EventReader reader(event, names_);
  if (steps_.empty()) begin(event);
  if (steps_.empty() || steps_.back().front() != event.step)
    steps_.push_back(Json::array({event.step}));
  steps_.back().push_back(trace_words(event, names_));
  if (is_message(event.kind)) add_message(reader);
  see_subject(reader);
}

// Draws the event in the lane of its subject.
void TimelineRecorder::see_subject(const EventReader& reader) {
  const link::Event& event = reader.event();
  const auto is_one_of = [&](About kind, const auto& list) {
    return reader.shape().subject == kind && event.subject < list.size();
  };
  if (is_one_of(About::channel, image_.channels))
    see_value(event, event.subject);
  else if (is_one_of(About::variable, image_.variables))
    see_value(event, image_.channels.size() + event.subject);
  else if (is_one_of(About::rule, image_.rules))
    see_rule(event);
  else if (is_one_of(About::actuator, image_.actuators))
    see_actuator(event);
}

void TimelineRecorder::see_value(const link::Event& event, std::size_t signal) {
  const bool known = event.kind != EventKind::stale && event.value_count != 0;
  page_["signals"][signal]["points"].push_back(
      {event.time_us, known ? value_of(event.values[0]) : Json(nullptr)});
}

void TimelineRecorder::see_rule(const link::Event& event) {
  const vm::Rule& rule = image_.rules[event.subject];
  if (event.kind == EventKind::win) {
    const bool then = event.value_count != 0 && event.values[0] != 0;
    const std::uint16_t response = then ? rule.then_response : rule.else_response;
    if (response >= image_.responses.size()) return;
    for (std::size_t i = 0; i < owners_.size(); ++i)
      if ((image_.responses[response].actuators >> i & 1) != 0) owners_[i] = event.subject;
  } else if (event.kind == EventKind::lose) {
    deny(event);
  } else if (event.kind == EventKind::trip) {
    page_["safety"].push_back(
        {{"from", event.time_us}, {"to", nullptr}, {"rule", event.subject}, {"step", event.step}});
  } else if (event.kind == EventKind::resume) {
    for (Json& trip : page_["safety"])
      if (trip["rule"] == event.subject && trip["to"].is_null()) trip["to"] = event.time_us;
  }
}

void TimelineRecorder::deny(const link::Event& event) {
  page_["denied"].push_back({{"at", event.time_us},
                             {"behavior", behavior_of(event.subject)},
                             {"text", trace_words(event, names_)},
                             {"rule", event.subject},
                             {"step", event.step}});
}

void TimelineRecorder::see_actuator(const link::Event& event) {
  const std::size_t actuator = event.subject;
  switch (event.kind) {
    case EventKind::command:
      end_state(actuator, event.time_us);
      begin_bar(event);
      break;
    case EventKind::done:
      end_bar(actuator, event.time_us);
      break;
    case EventKind::cancel:
      end_state(actuator, event.time_us);
      break;
    case EventKind::halt:
      end_state(actuator, event.time_us);
      end_halt(actuator, event.time_us);
      halted_[actuator] = true;
      page_["actuators"][actuator]["halts"].push_back({event.time_us, nullptr});
      break;
    case EventKind::release:
      end_halt(actuator, event.time_us);
      break;
    default:
      break;
  }
}

// In the list of those that the page shows.
std::size_t TimelineRecorder::place_of(drivers::Picture picture) {
  const auto place =
      static_cast<std::size_t>(std::ranges::find(pictures_, picture) - pictures_.begin());
  if (place == pictures_.size()) {
    pictures_.push_back(picture);
    page_["pictures"].push_back(rows_of(picture));
  }
  return place;
}

// The command without the actuator, which names the lane.
void TimelineRecorder::begin_bar(const link::Event& event) {
  std::string text = trace_words(event, names_);
  const std::string name(image_.string(image_.actuators[event.subject].name));
  if (text.starts_with(name + " ")) text.erase(0, name.size() + 1);
  const std::optional<std::size_t> rule = owners_[event.subject];
  page_["actuators"][event.subject]["bars"].push_back({{"from", event.time_us},
                                                       {"to", nullptr},
                                                       {"behavior", rule ? behavior_of(*rule) : -1},
                                                       {"text", text},
                                                       {"rule", rule ? Json(*rule) : Json(nullptr)},
                                                       {"step", event.step}});
  if (shows_pictures(image_.actuators[event.subject]))
    if (const auto picture = picture_of(EventReader(event, names_)))
      page_["actuators"][event.subject]["bars"].back()["picture"] = place_of(*picture);
  moves_[event.subject] = true;
  lasts_[event.subject] = has_lasting_effect(event, names_);
}

void TimelineRecorder::end_bar(std::size_t actuator, std::uint64_t at) {
  if (moves_[actuator]) page_["actuators"][actuator]["bars"].back()["to"] = at;
  moves_[actuator] = false;
}

// What a command has brought about may outlast it: `until` says to when.
void TimelineRecorder::end_state(std::size_t actuator, std::uint64_t at) {
  end_bar(actuator, at);
  if (lasts_[actuator]) page_["actuators"][actuator]["bars"].back()["until"] = at;
  lasts_[actuator] = false;
}

void TimelineRecorder::end_halt(std::size_t actuator, std::uint64_t at) {
  if (halted_[actuator]) page_["actuators"][actuator]["halts"].back()[1] = at;
  halted_[actuator] = false;
}

void TimelineRecorder::add_message(const EventReader& reader) {
  const link::Event& event = reader.event();
  page_["messages"].push_back({{"at", event.time_us},
                               {"kind", reader.shape().name},
                               {"text", trace_words(event, names_)},
                               {"step", event.step}});
}

Json TimelineRecorder::finish(std::uint64_t end_us) {
  for (std::size_t i = 0; i < moves_.size(); ++i) {
    end_state(i, end_us);
    end_halt(i, end_us);
  }
  for (Json& trip : page_["safety"])
    if (trip["to"].is_null()) trip["to"] = end_us;
  page_["end_us"] = end_us;
  page_["steps"] = std::move(steps_);
  return std::move(page_);
}

}  // namespace robosync::tool
