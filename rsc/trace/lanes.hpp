// A trace as drawable lanes: spans from when to when, values over time, and moments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rsc/trace/trace_file.hpp"

namespace robosync::tool {

// In the order in which a person reads them.
enum class LaneGroup : std::uint8_t { robot, safety, behaviors, actuators, variables, sensors };
inline constexpr std::size_t kLaneGroups = 6;
[[nodiscard]] std::string_view name_of(LaneGroup group);

struct Span {
  std::uint64_t from_us = 0, to_us = 0;
  std::string text;
};

struct Moment {
  std::uint64_t at_us = 0;
  std::string text;
};

struct Sample {
  std::uint64_t at_us = 0;
  std::optional<double> number;  // neither number nor word: unknown
  std::string word;
};

struct Lane {
  LaneGroup group{};
  std::string name;
  std::vector<Span> spans;      // one after the other
  std::vector<Moment> moments;  // what was denied to it; messages
};

struct Curve {
  LaneGroup group{};
  std::string name, unit;
  bool has_words = false;
  std::vector<Sample> samples;
};

// Takes the lines of a trace in order.
class Lanes {
public:
  void see(const TraceLine& line);
  // Ends everything still open.
  void finish();

  const std::vector<Lane>& lanes() const { return lanes_; }
  const std::vector<Curve>& curves() const { return curves_; }
  std::uint64_t end_us() const { return end_us_; }

private:
  Lane& lane(LaneGroup group, const std::string& name);
  void begin(LaneGroup group, const std::string& name, const std::string& text);
  void end(LaneGroup group, const std::string& name);
  void end_all();
  void mark(LaneGroup group, const std::string& name, const std::string& text);
  void see_rule(const TraceLine& line, const std::string& kind);
  void see_actuator(const TraceLine& line, const std::string& kind);
  void see_value(const TraceLine& line, const std::string& kind);

  std::vector<Lane> lanes_;
  std::vector<Curve> curves_;
  std::map<std::pair<LaneGroup, std::string>, std::size_t> lane_of_, curve_of_;
  std::map<std::pair<LaneGroup, std::string>, bool> goes_on_;
  std::uint64_t end_us_ = 0;
};

}  // namespace robosync::tool
