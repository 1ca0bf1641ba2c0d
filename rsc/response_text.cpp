// Response times as a table, as JSON, and as the reason for a refusal.
#include <algorithm>

#include <fmt/format.h>

#include "rsc/json.hpp"
#include "rsc/timing.hpp"

namespace robosync::tool {
namespace {

using analysis::Contributor, analysis::Instructions, analysis::PathTiming, analysis::ResponseTime,
    analysis::ResponseReport;

constexpr double kPercent = 100;
constexpr std::size_t kShown = 3;

std::string time_text(const ResponseReport& report, const ResponseTime& response) {
  if (!response.bounded) return fmt::format("{:>10}{:>10}", "no bound", "");
  return fmt::format("{:>10}{:>10}", response.time, report.microseconds(response.time));
}

const ResponseTime& worst_of(const PathTiming& path) {
  if (path.adapted.time == 0) return path.base;
  const bool base =
      !path.base.bounded || (path.adapted.bounded && path.base.time > path.adapted.time);
  return base ? path.base : path.adapted;
}

// "33000 of near, 178 of arm": what costs most.
std::string first_of(const std::vector<Contributor>& contributors) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, contributors.size()); ++i)
    text +=
        fmt::format("{}{} for {}", i == 0 ? "" : ", ", contributors[i].cost, contributors[i].name);
  return text;
}

std::string share_text(const PathTiming& path, const ResponseTime& response) {
  if (!response.bounded) return fmt::format("{:>8} %", "> 100");
  return fmt::format("{:>8.1f} %", kPercent * path.share(response));
}

// If a WAIT is the cause, sensors are not.
std::string mend_of(const ResponseReport& report) {
  if (report.short_wait == analysis::TaskSet::kNoWait && !report.has_sensors)
    return "let rules run less often, or make those that cost most cheaper";
  if (report.short_wait == analysis::TaskSet::kNoWait)
    return "give a sensor a lower rate in robot.json, let rules run less often or fewer read it, "
           "or "
           "make those that cost most cheaper";
  return fmt::format(
      "{} may be 0 s: write a number, RANDOM of numbers or MAX(1s, a variable), or a WAIT 1s "
      "before it",
      report.short_wait == 0 ? "a WAIT" : fmt::format("the WAIT at line {}", report.short_wait));
}

std::string late_text(const ResponseReport& report, const PathTiming& path) {
  const ResponseTime& worst = worst_of(path);
  const std::string name = fmt::format("{} -> {}", path.sensor, path.actuator);
  if (!worst.bounded) return fmt::format("there is no bound for {}", name);
  return fmt::format("{} takes up to {} us, and the next reading may come after {} us", name,
                     report.microseconds(worst.time), report.microseconds(path.period));
}

Json response_object(const ResponseReport& report, const ResponseTime& response) {
  if (!response.bounded) return nullptr;
  return {{"instructions", response.time}, {"microseconds", report.microseconds(response.time)}};
}

}  // namespace

std::string response_text(const ResponseReport& report) {
  std::string text =
      report.paths.empty()
          ? "        No reading commands an actuator in its own step.\n"
          : fmt::format("        {:<36}{:>10}{:>10}{:>10}{:>10}\n", "from a reading to the command",
                        "at most", "us", "every us", "share");
  for (const PathTiming& path : report.paths) {
    const ResponseTime& worst = worst_of(path);
    text += fmt::format(
        "        {:<36}{}{:>10}{}\n", fmt::format("{} -> {}", path.sensor, path.actuator),
        time_text(report, path.base), report.microseconds(path.period), share_text(path, worst));
    if (report.adapts)
      text += fmt::format("        {:<36}{}\n", "  … others adapted to P_max",
                          time_text(report, path.adapted));
  }
  return text + fmt::format("        {:<36}{:>48.1f} %\n", "processor, in total",
                            kPercent * report.utilization);
}

Json response_json(const ResponseReport& report) {
  Json object{{"utilization", report.utilization},
              {"schedulable", report.schedulable()},
              {"instructions_per_ms", report.instructions_per_ms},
              {"paths", Json::array()},
              {"loads", Json::array()}};
  for (const Contributor& load : report.loads)
    object["loads"].push_back({{"what", load.name}, {"instructions_per_ms", load.cost}});
  for (const PathTiming& path : report.paths) {
    Json entry{{"sensor", path.sensor},
               {"actuator", path.actuator},
               {"period_us", report.microseconds(path.period)},
               {"base", response_object(report, path.base)}};
    if (report.adapts) entry["adapted"] = response_object(report, path.adapted);
    object["paths"].push_back(std::move(entry));
  }
  return object;
}

// The processor as a whole, or else the first late path; a sensor's other paths are just as late.
Overload overload_of(const ResponseReport& report) {
  if (report.schedulable()) return {};
  Overload overload;
  if (report.utilization > 1) {
    overload.what =
        fmt::format("it may take {:.0f} % of the processor", kPercent * report.utilization);
    overload.why.push_back(fmt::format("a millisecond has {} instructions; the program may take {}",
                                       report.instructions_per_ms, first_of(report.loads)));
  } else {
    const PathTiming& path =
        *std::ranges::find_if(report.paths, [](const PathTiming& one) { return !one.in_time(); });
    overload.what = late_text(report, path);
    const ResponseTime& worst = worst_of(path);
    if (worst.bounded)
      overload.why.push_back(
          fmt::format("most of its {} instructions: {}", worst.time, first_of(worst.contributors)));
  }
  overload.why.push_back(mend_of(report));
  return overload;
}

}  // namespace robosync::tool
