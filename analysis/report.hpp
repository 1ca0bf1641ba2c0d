// The response times of a program, path by path, and whether the board can keep up with it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/response_time.hpp"
#include "analysis/task_set.hpp"
#include "runtime-m4/policy/costs.hpp"
#include "vm/image.hpp"

namespace robosync::analysis {

struct PathTiming {
  std::string sensor, actuator;
  Instructions period = 0;  // of the sensor: the reading must be answered before the next one
  Instructions measuring =
      0;  // by the sensor, before it is sampled; the next measurement may begin meanwhile
  ResponseTime base;
  ResponseTime adapted;  // only if priorities adapt
  [[nodiscard]] bool in_time() const;
  // The share of the period for which the reading is being processed; 1: until the next one.
  [[nodiscard]] double share(const ResponseTime& response) const;
};

struct ResponseReport {
  Instructions instructions_per_ms = 0;  // executed by the board
  double utilization = 0;
  bool adapts = false;
  std::vector<PathTiming> paths;
  std::vector<Contributor> loads;          // per millisecond, the largest first
  unsigned short_wait = TaskSet::kNoWait;  // as in TaskSet
  bool has_sensors = true;                 // that the program reads
  [[nodiscard]] bool schedulable() const;
  // Rounded up.
  [[nodiscard]] Instructions microseconds(Instructions instructions) const;
};

// What to compute if the processor as a whole is overloaded: only that, or every path nevertheless.
enum class Depth : std::uint8_t { until_refused, all };

// For image, `module_cost` and `cap` see task_set.hpp.
[[nodiscard]] ResponseReport response_report(const vm::Image& image,
                                             const policy::BoardCosts& board,
                                             ModuleCost module_cost, int cap = 0,
                                             Depth depth = Depth::all);

}  // namespace robosync::analysis
