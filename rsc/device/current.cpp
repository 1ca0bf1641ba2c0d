// See current.hpp. The board's data is not trusted.
#include "rsc/device/current.hpp"

#include <algorithm>

#include "rsc/json.hpp"
#include "rsc/trace/event_reader.hpp"

namespace robosync::tool {
namespace {

using link::EventKind;

void add(Current& current, std::uint64_t time_us, EventKind kind, std::size_t subject) {
  link::Event event;
  event.time_us = time_us;
  event.kind = kind;
  event.subject = static_cast<std::uint16_t>(subject);
  current.events.push_back(event);
}

void add_value(Current& current, const link::State& state, std::size_t input, vm::Value value,
               std::size_t channels) {
  if (value == vm::kUnknown) return;
  const bool is_channel = input < channels;
  add(current, state.program_us, is_channel ? EventKind::input : EventKind::set,
      is_channel ? input : input - channels);
  current.events.back().value_count = 1;
  current.events.back().values[0] = value;
}

// The value of a TIMER or a SIGNAL means nothing to a person.
bool is_told(const vm::Image& image, std::size_t input) {
  if (input < image.channels.size()) return true;
  const vm::VariableKind kind = image.variables[input - image.channels.size()].kind;
  return kind != vm::VariableKind::timer && kind != vm::VariableKind::signal;
}

void add_safety(Current& current, const link::State& state, const vm::Image& image) {
  constexpr std::size_t kBits = 32;
  const std::size_t rules = std::min(image.rules.size(), state.tripped.size() * kBits);
  for (std::size_t r = 0; r < rules; ++r)
    if ((state.tripped.at(r / kBits) >> r % kBits & 1) != 0)
      add(current, state.program_us, EventKind::trip, r);
  for (std::size_t a = 0; a < std::min(image.actuators.size(), kBits); ++a)
    if ((state.halted >> a & 1) != 0) add(current, state.program_us, EventKind::halt, a);
}

}  // namespace

Current current_of(Client& client, const vm::Image* image) {
  Current current;
  link::State state = client.state(0);
  current.stopped = state.stopped != 0;
  if (image == nullptr) return current;
  add_safety(current, state, *image);
  const std::size_t channels = image->channels.size();
  const std::size_t inputs = channels + image->variables.size();
  std::size_t input = 0;
  while (input < inputs && state.count != 0) {
    const std::size_t count = std::min<std::size_t>(state.count, state.values.size());
    for (std::size_t i = 0; i < count && input < inputs; ++i, ++input)
      if (is_told(*image, input)) add_value(current, state, input, state.values.at(i), channels);
    if (input < inputs) state = client.state(static_cast<std::uint32_t>(input));
  }
  return current;
}

std::vector<Held> held_back(const Current& current, const TraceNames& names) {
  std::vector<Held> held;
  if (current.stopped)
    held.push_back({"stopped", "all outputs are in their safe state until `rsc resume`"});
  for (const link::Event& event : current.events) {
    const EventReader reader(event, names);
    if (event.kind == EventKind::trip) held.push_back({"tripped", reader.rule_name()});
    if (event.kind == EventKind::halt) held.push_back({"halted", reader.actuator_name()});
  }
  return held;
}

Json current_json(const Current& current, const TraceNames& names) {
  Json object{{"stopped", current.stopped}, {"tripped", Json::array()}, {"halted", Json::array()}};
  for (const link::Event& event : current.events) {
    const EventReader reader(event, names);
    if (event.kind == EventKind::halt) object["halted"].push_back(reader.actuator_name());
    if (event.kind != EventKind::trip) continue;
    Json rule{{"rule", event.subject}};
    if (reader.rule() != nullptr) rule["line"] = reader.rule()->line;
    object["tripped"].push_back(rule);
  }
  return object;
}

}  // namespace robosync::tool
