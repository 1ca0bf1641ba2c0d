// Feeds the readings of a recording to a simulated robot, each to the step that had it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "rsc/json.hpp"
#include "rsc/trace/replay_file.hpp"
#include "rsc/trace/replay_readings.hpp"
#include "runtime-m4/sim/simulator.hpp"
#include "vm/image.hpp"

namespace robosync::tool {

class ReplayFeeder {
public:
  // `silent`: the channels that became silent. All arguments must outlive it.
  ReplayFeeder(sim::Simulator& simulator, const RecordedProgram& recorded, const vm::Image& image,
               const Readings& readings, const std::set<std::uint8_t>& silent);

  // Runs the robot until the last recorded event.
  void run();
  // Gets each event of that robot when it happens.
  void see(const Json& event);

private:
  // The last event of a step: what it is about, and which one of these it is, from 1.
  struct Mark {
    std::string about;
    std::size_t number = 0;
  };

  [[nodiscard]] const Mark* step_before(const Told& told);
  void feed_held();
  void repeat(const Told& told);

  sim::Simulator& simulator_;
  const vm::Image& image_;
  const Readings& readings_;
  const std::set<std::uint8_t>& silent_;
  std::uint64_t end_us_;
  std::map<std::pair<std::uint64_t, std::uint64_t>, Mark> recorded_;  // by time and step
  std::map<std::string, std::size_t> seen_;  // how many events, by what they are about
  std::span<const Told> held_;               // the readings of the next step that has some, …
  const Mark* awaited_ = nullptr;            // … which follows this event in its millisecond
};

}  // namespace robosync::tool
