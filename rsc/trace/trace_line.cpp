// Trace events as lines for people. Promises a line for every event, whatever its numbers.
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "rsc/names.hpp"
#include "rsc/trace/event_reader.hpp"
#include "rsc/trace/time_units.hpp"
#include "rsc/trace/trace_format.hpp"
#include "vm/drivers.hpp"

namespace robosync::tool {
namespace {

using link::EventKind;

constexpr std::array<std::string_view, EventReader::kParamCount> kParamWords = {
#define PARAM(name, spelling, doc) spelling,
#include "vm/params.def"
#undef PARAM
};

std::string command_words(const EventReader& reader) {
  std::string text = fmt::format("{} {}", reader.actuator_name(), reader.verb_name());
  if (const auto word = reader.word_name()) text += " " + shown_word(*word);
  reader.for_each_param([&](std::size_t param, vm::Value given) {
    const std::string_view spelling = kParamWords.at(param);
    if (spelling.empty() || reader.is_said(param)) return;  // the verb's word says it
    text += fmt::format(" {} {}", spelling, reader.shown(param, given));
  });
  return reader.is_carried_out() ? text : text + " (not done: a value is unknown)";
}

// " its ELSE side": only a rule with ELSE has two sides.
std::string side(const EventReader& reader) {
  const vm::Rule* const rule = reader.rule();
  if (reader.value(0) == 0) return " its ELSE side";
  return rule == nullptr || rule->else_response != vm::kNoIndex ? " its DO side" : "";
}

std::string interrupt_words(const EventReader& reader) {
  if (reader.interrupts_itself()) {
    return fmt::format("{} gives up what it was doing", reader.rule_name());
  }
  return fmt::format("{} is interrupted by {}", reader.rule_name(),
                     reader.behavior_name(reader.event().object));
}

// A rule may be denied by its own behaviour.
std::string denial_words(const EventReader& reader) {
  if (reader.event().object == link::kStop) return "the robot is stopped";
  if (!reader.interrupts_itself())
    return fmt::format("{} has an actuator it needs", reader.behavior_name(reader.event().object));
  return reader.is_only_rule() ? "its response is still running"
                               : "it, or another rule of its behaviour, is still running";
}

std::string rule_words(const EventReader& reader) {
  const std::string rule = reader.rule_name();
  switch (reader.event().kind) {
    case EventKind::fire:
      return fmt::format("{} triggers{}", rule, side(reader));
    case EventKind::win:
      return fmt::format("{} starts{}", rule, side(reader));
    case EventKind::lose:
      return fmt::format("{} does not start{}: {}", rule, side(reader), denial_words(reader));
    case EventKind::interrupt:
      return interrupt_words(reader);
    case EventKind::finished:
      return fmt::format("{} is finished", rule);
    case EventKind::wait:
      return fmt::format("{} waits", rule);
    case EventKind::go_on:
      return fmt::format("{} goes on", rule);
    case EventKind::trip:
      return fmt::format("SAFETY: {} trips", rule);
    case EventKind::resume:
      return fmt::format("SAFETY: {} lets go", rule);
    case EventKind::zero_divide:
      return fmt::format("{} divided by zero, which gave 0", rule);
    default:
      return fmt::format("{}: {}", rule, reader.shape().name);
  }
}

std::string actuator_words(const EventReader& reader) {
  const std::string actuator = reader.actuator_name();
  switch (reader.event().kind) {
    case EventKind::command:
      return command_words(reader);
    case EventKind::done:
      return fmt::format("{} is done", actuator);
    case EventKind::cancel:
      return fmt::format("{} is told to give up", actuator);
    case EventKind::overrun:
      return fmt::format("{} drops a command: too many wait", actuator);
    case EventKind::blocked:
      return fmt::format("{} is blocked: one of its wheels gives no edges, or too many", actuator);
    case EventKind::halt:
      return fmt::format("{} is halted", actuator);
    case EventKind::release:
      return fmt::format("{} may move again", actuator);
    default:
      return fmt::format("{}: {}", actuator, reader.shape().name);
  }
}

std::string priority_words(const EventReader& reader) {
  const std::string behavior = reader.behavior_name(reader.event().subject);
  const auto written = reader.base_priority();
  if (written == reader.value(0))
    return fmt::format("{} has its priority of {} back", behavior, written);
  return fmt::format("{} has priority {} now, in place of {}", behavior, reader.value(0), written);
}

std::string device_words(const EventReader& reader) {
  const vm::Sensor* const sensor = reader.sensor();
  const std::string text = sensor == nullptr
                               ? reader.sensor_name()
                               : name_on_bus(reader.sensor_name(), sensor->address, sensor->bus,
                                             vm::is_on_spi(sensor->driver));
  const bool silent = reader.event().kind == EventKind::silent;
  if (sensor != nullptr && vm::is_by_echo(sensor->driver))
    return fmt::format("{}, trigger {} and echo {}, {} ({} times without one so far)",
                       reader.sensor_name(), sensor->bus, sensor->address,
                       silent ? "hears no echo" : "hears an echo again", reader.value(0));
  if (sensor != nullptr && vm::is_analog(sensor->driver))
    return fmt::format("{} on analog pin {} {} ({} times without a voltage so far)",
                       reader.sensor_name(), sensor->address,
                       silent ? "is not measured" : "is measured again", reader.value(0));
  if (sensor != nullptr && vm::counts_edges(sensor->driver))
    return fmt::format(
        "{} on pin {} {} ({} times so far)", reader.sensor_name(), sensor->address,
        silent ? "loses edges: there are more than a board counts" : "loses no edges any more",
        reader.value(0));
  if (sensor != nullptr && vm::is_microphone(sensor->driver))
    return fmt::format("{} {} ({} times without sound so far)", reader.sensor_name(),
                       silent ? "hears nothing" : "hears again", reader.value(0));
  if (sensor != nullptr && vm::is_board_part(sensor->driver))
    return fmt::format("{} {} ({} times without a reading so far)", reader.sensor_name(),
                       silent ? "is not measured" : "is measured again", reader.value(0));
  if (sensor != nullptr && vm::measures_when_told(sensor->driver))
    return text + fmt::format(" {} ({} times without a distance so far)",
                              silent ? "sees nothing" : "sees something again", reader.value(0));
  return text + fmt::format(" {} ({} failed transfers so far)",
                            silent ? "does not answer" : "answers again", reader.value(0));
}

// An algorithm's output is as old as its input: if that is never stale, the module was stopped.
std::string why_stale(const EventReader& reader) {
  if (!reader.is_made()) return "no reading for too long";
  return reader.channel()->stale_ms == 0 ? "its module was stopped"
                                         : "its module has made nothing for too long";
}

std::string other_words(const EventReader& reader) {
  switch (reader.event().kind) {
    case EventKind::activated:
      return fmt::format("the program starts, seed {}",
                         static_cast<std::uint32_t>(reader.value(0)));
    case EventKind::input:
      return fmt::format("{} {} = {}", reader.sensor_name(), reader.channel_name(),
                         reader.shown(reader.value(0)));
    case EventKind::stale:
      return fmt::format("{} {} is unknown: {}", reader.sensor_name(), reader.channel_name(),
                         why_stale(reader));
    case EventKind::set:
      if (reader.is_signal()) return fmt::format("signal {}", reader.variable_name());
      if (reader.is_timer()) return fmt::format("{} is restarted", reader.variable_name());
      return fmt::format("{} becomes {}", reader.variable_name(), reader.shown(reader.value(0)));
    case EventKind::log:
      return fmt::format("log: {}", reader.text());
    case EventKind::alert:
      return fmt::format("ALERT: {}", reader.text());
    case EventKind::fault:
      return fmt::format("{} is stopped by a fault", reader.thread_words());
    case EventKind::deadline:
      return fmt::format("{} is late by {} us", reader.thread_words(), reader.value(0));
    case EventKind::lowered:
      return fmt::format(
          "{} runs longer than its module declares: it ranks below all behaviours now",
          reader.sensor_name());
    case EventKind::priority:
      return priority_words(reader);
    case EventKind::silent:
    case EventKind::answers:
      return device_words(reader);
    default:
      return std::string(reader.shape().name);
  }
}

}  // namespace

std::string trace_words(const link::Event& event, const TraceNames& names) {
  const EventReader reader(event, names);
  if (reader.shape().subject == About::rule) return rule_words(reader);
  if (reader.shape().subject == About::actuator) return actuator_words(reader);
  return other_words(reader);
}

// A text of the program may contain terminal control characters.
std::string trace_line(const link::Event& event, const TraceNames& names) {
  constexpr char kDelete = 0x7F;
  std::string line = seconds_text(event.time_us, 4) + "  ";
  for (const char c : trace_words(event, names)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < ' ' || c == kDelete)
      line += fmt::format("\\x{:02x}", byte);
    else
      line += c;
  }
  return line;
}

}  // namespace robosync::tool
