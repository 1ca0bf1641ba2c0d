// See replay.hpp.
#include "rsc/trace/replay.hpp"

#include <set>
#include <utility>

#include <fmt/format.h>

#include "rsc/failure.hpp"
#include "rsc/json.hpp"
#include "rsc/program.hpp"
#include "rsc/trace/replay_comparison.hpp"
#include "rsc/trace/replay_event.hpp"
#include "rsc/trace/replay_feeder.hpp"
#include "rsc/trace/replay_image.hpp"
#include "rsc/trace/replay_readings.hpp"
#include "rsc/trace/trace_format.hpp"
#include "runtime-m4/sim/simulator.hpp"

namespace robosync::tool {
namespace {

constexpr std::uint64_t kLongestUs = std::uint64_t{24} * 3600 * 1'000'000;
constexpr int kMostAttempts = 16;  // to find when readings came

std::uint32_t seed_of(const RecordedProgram& recorded) {
  const Json seed = recorded.events.front().event.value("seed", Json(nullptr));
  return seed.is_number_integer() ? static_cast<std::uint32_t>(seed.get<std::int64_t>()) : 0;
}

// SAFETY did something at this time in the replay only. Perhaps it had already seen the readings of the next, late steps on the
// board. False: there are none.
bool bring_forward(Readings& readings, std::uint64_t to_us) {
  bool found = false;
  for (Told& told : readings) {
    if (told.at_us <= to_us || told.at_us > to_us + kMostLateUs) continue;
    told.at_us = to_us;
    told.came_earlier = found = true;
  }
  return found;
}

template <typename Try>
Replayed best_of(const Try& attempt, Readings& readings) {
  Compared best = attempt();
  Compared last = best;
  for (int i = 1; i < kMostAttempts && last.result.difference && last.safety_alone_us &&
                  bring_forward(readings, *last.safety_alone_us);
       ++i) {
    last = attempt();
    if (!last.result.difference || last.result.events > best.result.events) best = last;
  }
  return best.result;
}

}  // namespace

Replayed replay(const RecordedProgram& recorded, const std::string& file,
                std::span<const std::byte> in_its_place) {
  const std::string name = fmt::format("{}:{}: the program that starts here", file, recorded.line);
  if (time_of(recorded.events.back().event) > kLongestUs)
    throw Failure(Exit::program, name + " ran for longer than a day, which is too long to replay");
  const bool is_other = !in_its_place.empty();
  const Program program(
      with_fed_sensors(is_other ? std::vector(in_its_place.begin(), in_its_place.end())
                                : recorded.image),
      name);
  const vm::Image& image = program.image();
  Readings readings = readings_of(recorded, image, file);
  const TraceNames names{&image, {}, nullptr};
  const auto attempt = [&] {
    std::vector<Decided> replayed;
    ReplayFeeder* feeder = nullptr;
    const auto take = [&](const link::Event& event) {
      Json line = read_json(trace_json(event, names));
      if (feeder != nullptr) feeder->see(line);
      if (is_compared(kind_of(line))) replayed.push_back({std::move(line), event});
    };
    const std::set<std::uint8_t> silent = silent_ones(readings);
    const std::vector<std::byte> bytes =
        with_beginnings(with_plain_channels(program, silent), recorded);
    sim::Simulator simulator(bytes, take, program.board(), seed_of(recorded));
    if (!simulator.verdict().ok())
      throw Failure(Exit::program, name + " does not run on this computer");
    ReplayFeeder own(simulator, recorded, image, readings, silent);
    feeder = &own;
    feeder->run();
    return compare(recorded.events, replayed, is_other ? Lines::of_another : Lines::compared,
                   names);
  };
  Replayed result = best_of(attempt, readings);
  if (is_other) result.unrecorded = unrecorded(recorded, image);
  return result;
}

}  // namespace robosync::tool
