// See replay_feeder.hpp.
#include "rsc/trace/replay_feeder.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <string_view>

#include "rsc/trace/replay_event.hpp"
#include "rsc/trace/time_units.hpp"

namespace robosync::tool {
namespace {

class Feeder {
public:
  Feeder(sim::Simulator& simulator, const RecordedProgram& recorded, const vm::Image& image)
      : simulator_(simulator), image_(image), end_us_(time_of(recorded.events.back().event)) {
    for (const RecordedEvent& one : recorded.events)
      if (is_of_step(kind_of(one.event)) && !is_beginning(one.event))
        first_step_.try_emplace(time_of(one.event), step_of(one.event));
  }

  void run(const Readings& readings, const std::set<std::uint8_t>& silent) {
    for (std::size_t i = 0; i < readings.size(); ++i) {
      const Told& told = readings[i];
      // An earlier step in this millisecond did not have this reading, nor others of the same step.
      const bool is_first_of_step = i == 0 || readings[i - 1].step != told.step;
      if (is_first_of_step && !told.came_earlier && first_step_.at(told.at_us) < told.step)
        simulator_.run_until(told.at_us);
      if (!told.value) continue;
      simulator_.feed(told.at_us, told.channel, *told.value);
      if (silent.contains(told.channel)) repeat(told, next_of(readings, i));
    }
    simulator_.run_until(end_us_);
  }

private:
  // Events that the board stamps with the time of a step; other events have their own times.
  static bool is_of_step(std::string_view kind) {
    constexpr std::string_view kOfStep[] = {"input",     "stale",   "set",        "fire",
                                            "win",       "lose",    "go_on",      "wait",
                                            "interrupt", "overrun", "zero_divide"};
    return std::ranges::find(kOfStep, kind) != std::end(kOfStep);
  }

  static const Told* next_of(const Readings& readings, std::size_t i) {
    for (std::size_t next = i + 1; next < readings.size(); ++next)
      if (readings[next].channel == readings[i].channel) return &readings[next];
    return nullptr;
  }

  // A channel that can become silent gets its value again until then; it becomes silent `life` after the last one
  // (layers/mailbox.hpp).
  void repeat(const Told& told, const Told* next) {
    const std::uint64_t life_us = (image_.channels[told.channel].stale_ms + 1U) * kMicroseconds;
    const std::uint64_t again_us = std::max(life_us / 2, kMicroseconds);
    const std::uint64_t next_us = next == nullptr ? end_us_ : next->at_us;
    const bool falls_silent = next != nullptr && !next->value;
    std::uint64_t until_us = next_us;
    if (falls_silent) until_us = next_us > life_us ? next_us - life_us : 0;
    for (std::uint64_t at = told.at_us + again_us; at < until_us; at += again_us)
      simulator_.feed(at, told.channel, *told.value);
    if (falls_silent && until_us > told.at_us) simulator_.feed(until_us, told.channel, *told.value);
  }

  sim::Simulator& simulator_;
  const vm::Image& image_;
  std::uint64_t end_us_;
  std::map<std::uint64_t, std::uint64_t> first_step_;  // by time
};

}  // namespace

void feed_readings(sim::Simulator& simulator, const RecordedProgram& recorded,
                   const vm::Image& image, const Readings& readings,
                   const std::set<std::uint8_t>& silent) {
  Feeder(simulator, recorded, image).run(readings, silent);
}

}  // namespace robosync::tool
