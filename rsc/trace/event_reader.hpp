// A trace event with the names of what it is about. It may come over the line and belong to another
// image: a number that the image does not have is shown as a number.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "link/events.hpp"
#include "rsc/trace/trace_format.hpp"
#include "vm/image.hpp"

namespace robosync::tool {

// What the subject and the object of an event are (events.def).
enum class About : std::uint8_t {
  none,
  sensor,
  channel,
  variable,
  rule,
  behavior,
  actuator,
  verb,
  word,
  thread,
  string,
  refusal
};

struct EventShape {
  link::EventKind kind;
  std::string_view name;
  About subject, object;
  std::string_view values;
};

// What kind of value an input has.
struct Meaning {
  vm::Dimension dimension = vm::Dimension::number;
  std::uint16_t first_label = 0;
  std::uint8_t label_count = 0;
  const compiler::Unit* unit = nullptr;  // the author's; null: the canonical one
};

class EventReader {
public:
  EventReader(const link::Event& event, const TraceNames& names);

  const link::Event& event() const { return event_; }
  const EventShape& shape() const { return shape_; }

  std::span<const std::int32_t> values() const;
  vm::Value value(std::size_t index) const;  // kUnknown if the event has none

  const vm::Rule* rule() const;  // the subject; nullptr when the image does not have it
  // The named behaviour of the event's rule; empty outside one.
  std::string_view behavior_of_rule() const;
  bool is_safety_rule() const;
  // Is the behaviour (object) the one that the rule (subject) belongs to?
  bool interrupts_itself() const;

  // Has the behaviour of the rule (subject) no other rule?
  bool is_only_rule() const;

  std::string rule_name() const;
  // Of a SAFETY rule, if its source is known; else empty.
  std::string safety_name() const;
  std::int16_t base_priority() const;  // of the behaviour it is about, as written
  std::string behavior_name(std::uint16_t index) const;
  std::string sensor_name() const;     // of the subject, a sensor or a channel
  const vm::Sensor* sensor() const;    // the subject; nullptr when the image does not have it
  std::string channel_name() const;    // without its sensor
  const vm::Channel* channel() const;  // the subject; nullptr when the image does not have it
  bool is_made() const;                // the channel belongs to an algorithm
  std::string variable_name() const;
  bool is_signal() const;  // the variable is a SIGNAL
  bool is_timer() const;
  std::string actuator_name() const;
  std::string verb_name() const;
  // Of a command; nothing otherwise. `word_name` has the values filled into the {} places of its
  // text.
  std::optional<std::string> word_name() const;
  std::optional<std::string> written_word() const;
  const vm::WordEntry* word() const;  // nullptr when there is none, or the image does not have it
  // Is the parameter of a command a value for a {} place?
  bool is_said(std::size_t param) const;
  std::string thread_name() const;
  std::string thread_words() const;  // "behaviour shy"
  // The text of LOG and ALERT, with the values filled into its {} places.
  std::string text() const;

  // The durations, as a TIMER measures them, in a message, in what is said, or of a variable that is set.
  struct Duration {
    std::size_t value = 0;  // in values()
    std::size_t place = 0;  // of the text, from 0
  };
  std::vector<Duration> durations() const;

  // Of the subject, a channel or a variable.
  Meaning meaning() const;
  // The label of a value; empty if it has none.
  std::string_view label(const Meaning& meaning, vm::Value value) const;
  // The value of the subject: "scared", "20.5mm", "unknown".
  std::string shown(vm::Value value) const;
  // The value of a parameter of a command: "90deg".
  std::string shown(std::size_t param, vm::Value value) const;
  // The unit in which robot.json gives it; null if not known.
  const compiler::Unit* unit_of(vm::Param param) const;

  // Is it a command that its actuator carries out, that is, not one that says an unknown value?
  bool is_carried_out() const;
  // Calls use(parameter, value) for each parameter of a command.
  template <typename Use>
  void for_each_param(Use use) const {
    if (values().size() < 2) return;
    const auto mask = static_cast<std::uint32_t>(values()[1]);
    std::size_t next = 2;
    for (std::size_t param = 0; param < kParamCount; ++param) {
      if ((mask >> param & 1) != 0 && next < values().size()) use(param, values()[next++]);
    }
  }
  static constexpr auto kParamCount = static_cast<std::size_t>(vm::Param::count_);

private:
  template <typename Record>
  const Record* at(std::span<const Record> vm::Image::*section, std::size_t index) const {
    const bool there = names_.image != nullptr && index < (names_.image->*section).size();
    return there ? &(names_.image->*section)[index] : nullptr;
  }
  template <typename Record>
  std::string name_at(std::span<const Record> vm::Image::*section, std::size_t index,
                      std::string_view what) const;
  const vm::Behavior* behavior_with_rule() const;
  const compiler::Unit* written_unit(vm::Dimension dimension) const;
  // The place of the rule: "line 12", or "mood.rsl:12" in another file.
  std::string place_of(std::size_t rule) const;

  const link::Event& event_;
  const TraceNames& names_;
  const EventShape& shape_;
};

// The text of a command as lines show it: "Hello", or "" in quotes.
[[nodiscard]] std::string shown_word(std::string_view word);

// OVER and FOR are times; the other parameters have the unit of their actuator, which is not in the
// image.
[[nodiscard]] vm::Dimension dimension_of_param(std::size_t param);

}  // namespace robosync::tool
