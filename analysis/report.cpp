// See report.hpp.
#include "analysis/report.hpp"

#include <algorithm>
#include <utility>

namespace robosync::analysis {
namespace {

// What each source and interference takes of a millisecond.
std::vector<Contributor> loads_of(const TaskSet& set, Instructions per_ms) {
  std::vector<Contributor> loads;
  const auto add = [&](const std::string& name, Instructions cost, Instructions period) {
    add_share(loads, name, cost * per_ms / period);
  };
  for (const Source& source : set.sources)
    add(source.name, source.sample + source.step, source.period);
  for (const Firing& rule : set.firings)
    add_share(loads, rule.name,
              static_cast<Instructions>(utilization(set, rule) * static_cast<double>(per_ms)));
  for (const Interference& one : set.interferences)
    add(one.name, one.cost, one.period);
  std::ranges::stable_sort(loads, std::ranges::greater{}, &Contributor::cost);
  return loads;
}

// For an algorithm whose input is sampled, counts from that sample; for a sensor with an echo, of sound or
// light, from its pulse.
ResponseTime from_the_reading(const TaskSet& set, std::size_t source, Priorities priorities) {
  ResponseTime response = response_time_of(set, source, priorities);
  Instructions late = set.sources[source].jitter;
  if (ResponseTime whole = response_time_from_asking(set, source, priorities);
      whole.bounded && (!response.bounded || whole.time < response.time + late)) {
    late = set.sources[source].delay;
    response = std::move(whole);
    response.time -= late;
  }
  const Instructions measuring = set.sources[source].measuring;
  if (late + measuring == 0) return response;
  response.time += late + measuring;
  if (late != 0) response.contributors.push_back({"the wait for a sample of its input", late});
  if (measuring != 0) response.contributors.push_back({"the wait for its echo", measuring});
  std::ranges::stable_sort(response.contributors, std::ranges::greater{}, &Contributor::cost);
  return response;
}

bool keeps_up(const ResponseTime& response, Instructions period) {
  return response.bounded && response.time <= period;
}

}  // namespace

bool PathTiming::in_time() const {
  const Instructions next = period + measuring;
  return keeps_up(base, next) && (adapted.time == 0 || keeps_up(adapted, next));
}

double PathTiming::share(const ResponseTime& response) const {
  const Instructions processed = response.time - std::min(response.time, measuring);
  return static_cast<double>(processed) / static_cast<double>(period);
}

bool ResponseReport::schedulable() const {
  return utilization <= 1 && std::ranges::all_of(paths, &PathTiming::in_time);
}

Instructions ResponseReport::microseconds(Instructions instructions) const {
  return ceil_div(instructions * 1000, instructions_per_ms);
}

ResponseReport response_report(const vm::Image& image, const policy::BoardCosts& board,
                               ModuleCost module_cost, int cap, Depth depth) {
  const TaskSet base = task_set_of(image, board, module_cost);
  ResponseReport report;
  report.instructions_per_ms = board.instructions_per_ms();
  report.utilization = utilization(base);
  report.adapts = cap > 0;
  report.short_wait = base.short_wait;
  report.has_sensors = !image.channels.empty();
  report.loads = loads_of(base, report.instructions_per_ms);
  if (depth == Depth::until_refused && report.utilization > 1) return report;
  const TaskSet adapted = cap > 0 ? task_set_of(image, board, module_cost, cap) : TaskSet{};
  for (std::size_t s = 0; s < base.sources.size(); ++s) {
    const Source& source = base.sources[s];
    if (source.actuators.empty()) continue;
    PathTiming path;
    path.sensor = source.name;
    path.period = source.period;
    path.measuring = source.measuring != 0 ? source.measuring : source.early;
    path.base = from_the_reading(base, s, Priorities::base);
    if (cap > 0) path.adapted = from_the_reading(adapted, s, Priorities::adapted);
    for (const std::string& actuator : source.actuators) {
      path.actuator = actuator;
      report.paths.push_back(path);
    }
  }
  return report;
}

}  // namespace robosync::analysis
