// Records a run for its page (page.hpp): lanes of what was sensed, felt, commanded, halted and denied, over program time.
//
// As JSON, which timeline.js reads; times are in microseconds, values in thousandths of their canonical unit:
//   begin_us, end_us, behaviors: [name]
//   signals:   [{group: "sensor"|"variable", name, unit: {name, factor, offset, divisor}, labels: [word],
//                points: [[time, value or null]], thresholds: [{value, text, rule}]}]
//   actuators: [{name, bars: [{from, to, behavior: index or -1, text, rule, step, picture: index; only of one that shows pictures}],
//                halts: [[from, to]]}]
//   pictures:  [[row from the top, # for each light that is on]]
//   safety:    [{from, to, rule, step}]
//   denied:    [{at, behavior, text, rule, step}]
//   messages:  [{at, kind: the event's name in link/events.def, text, step}]
//   steps:     [[step, what happened in it, in words …]], in their order
//   rules:     [{name, line}]
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "link/events.hpp"
#include "rsc/json.hpp"
#include "rsc/program.hpp"
#include "rsc/timeline/pictures.hpp"
#include "rsc/trace/event_reader.hpp"
#include "rsc/trace/trace_format.hpp"

namespace robosync::tool {

// Takes the events of a run in order. Their numbers are not trusted.
class TimelineRecorder {
public:
  // `program` and `names` must outlive it.
  TimelineRecorder(const Program& program, const TraceNames& names);

  void see(const link::Event& event);
  // The whole run, which ended at `end_us`. Ends everything still open.
  [[nodiscard]] Json finish(std::uint64_t end_us);

private:
  void begin(const link::Event& first);
  void add_signals();
  void add_rules();
  void see_value(const link::Event& event, std::size_t signal);
  void see_rule(const link::Event& event);
  void see_actuator(const link::Event& event);
  void see_subject(const EventReader& reader);
  std::size_t place_of(drivers::Picture picture);
  void begin_bar(const link::Event& event);
  void end_bar(std::size_t actuator, std::uint64_t at);
  void end_state(std::size_t actuator, std::uint64_t at);
  void end_halt(std::size_t actuator, std::uint64_t at);
  void add_message(const EventReader& reader);
  void deny(const link::Event& event);
  int behavior_of(std::size_t rule) const;

  const vm::Image& image_;
  const TraceNames& names_;
  Json page_;
  Json steps_ = Json::array();
  std::vector<drivers::Picture> pictures_;          // that the page shows
  std::vector<std::optional<std::size_t>> owners_;  // of each actuator: the rule that started last
  std::vector<bool> moves_, halted_;                // … its last bar is open
  std::vector<bool> lasts_;                         // … what its last bar did lasts
};

}  // namespace robosync::tool
