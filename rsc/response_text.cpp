// Response times as a table for people, as JSON for programs, and as the reason of a refusal.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/costs.hpp"
#include "rsc/timing.hpp"

namespace robosync::tool {
namespace {

using analysis::Contributor, analysis::Instructions, analysis::PathTiming, analysis::Response,
    analysis::ResponseReport;
namespace costs = analysis::costs;
using Json = nlohmann::ordered_json;

constexpr Instructions kMicroseconds = 1000;  // in a millisecond
constexpr double kPercent = 100;
constexpr std::size_t kDearest = 3;

Instructions microseconds(Instructions instructions) {
  return (instructions * kMicroseconds + costs::kPerMillisecond - 1) / costs::kPerMillisecond;
}

std::string time_text(const Response& response) {
  if (!response.bounded) return fmt::format("{:>10}{:>10}", "no bound", "");
  return fmt::format("{:>10}{:>10}", response.time, microseconds(response.time));
}

const Response& worst_of(const PathTiming& path) {
  if (path.adapted.time == 0) return path.base;
  const bool base =
      !path.base.bounded || (path.adapted.bounded && path.base.time > path.adapted.time);
  return base ? path.base : path.adapted;
}

std::string dearest(const std::vector<Contributor>& contributors, std::string_view unit) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kDearest, contributors.size()); ++i)
    text += fmt::format("\n    {}: {} instructions{}", contributors[i].name, contributors[i].cost,
                        unit);
  return text;
}

std::string late_text(const PathTiming& path) {
  const Response& worst = worst_of(path);
  const std::string name = fmt::format("{} -> {}", path.sensor, path.actuator);
  if (!worst.bounded) return fmt::format("\n  {}: there is no bound for it", name);
  return fmt::format(
      "\n  {}: up to {} instructions ({} us), and the next may come after {} us; the "
      "dearest of it:{}",
      name, worst.time, microseconds(worst.time), microseconds(path.period),
      dearest(worst.contributors, ""));
}

Json response_object(const Response& response) {
  if (!response.bounded) return nullptr;
  return {{"instructions", response.time}, {"microseconds", microseconds(response.time)}};
}

}  // namespace

std::string response_text(const ResponseReport& report) {
  std::string text =
      fmt::format("        {:<36}{:>10}{:>10}{:>10}{:>10}\n", "from a reading to the command",
                  "at most", "us", "every us", "share");
  for (const PathTiming& path : report.paths) {
    const Response& worst = worst_of(path);
    const double share =
        kPercent * static_cast<double>(worst.time) / static_cast<double>(path.period);
    text += fmt::format("        {:<36}{}{:>10}{:>8.1f} %\n",
                        fmt::format("{} -> {}", path.sensor, path.actuator), time_text(path.base),
                        microseconds(path.period), share);
    if (report.adapts)
      text +=
          fmt::format("        {:<36}{}\n", "  … others adapted to P_max", time_text(path.adapted));
  }
  return text + fmt::format("        {:<36}{:>48.1f} %\n", "the processor, all of it",
                            kPercent * report.utilization);
}

Json response_json(const ResponseReport& report) {
  Json object{{"utilization", report.utilization},
              {"schedulable", report.schedulable()},
              {"instructions_per_ms", costs::kPerMillisecond},
              {"paths", Json::array()},
              {"loads", Json::array()}};
  for (const Contributor& load : report.loads)
    object["loads"].push_back({{"what", load.name}, {"instructions_per_ms", load.cost}});
  for (const PathTiming& path : report.paths) {
    Json entry{{"sensor", path.sensor},
               {"actuator", path.actuator},
               {"period_us", microseconds(path.period)},
               {"base", response_object(path.base)}};
    if (report.adapts) entry["adapted"] = response_object(path.adapted);
    object["paths"].push_back(std::move(entry));
  }
  return object;
}

std::string unschedulable_text(const ResponseReport& report) {
  if (report.schedulable()) return "";
  std::string text = "the board cannot keep up with it";
  if (report.utilization > 1) {
    text += fmt::format(
        "\n  all of it takes {:.0f} % of the processor; the dearest in a millisecond:{}",
        kPercent * report.utilization,
        dearest(report.loads, fmt::format(" of {}", costs::kPerMillisecond)));
  }
  for (const PathTiming& path : report.paths)
    if (!path.in_time()) text += late_text(path);
  return text +
         "\n  give a sensor a lower rate in robot.json, let fewer rules read it, or make the "
         "dearest "
         "rules cheaper";
}

}  // namespace robosync::tool
