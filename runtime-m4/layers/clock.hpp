// Milliseconds of program time, as the VM counts them. They wrap after 49 days, so only differences
// say which time is earlier; no difference that matters is longer than 24 days.
#pragma once

#include <algorithm>
#include <cstdint>

#include "vm/timers.hpp"

namespace robosync::layers {

inline constexpr std::uint32_t kNever = vm::Machine::kNever;

// While a time is remembered that may pass without a step, the step thread wakes at least this often, in milliseconds, to
// forget it before its difference becomes ambiguous.
inline constexpr std::uint32_t kLongestRest = std::uint32_t{1} << 30;

using vm::as_time;
using vm::reached;

// `time` comes before `other`; kNever comes after everything.
constexpr bool sooner(std::uint32_t time, std::uint32_t other) {
  if (time == kNever || other == kNever) return time != kNever && other == kNever;
  return static_cast<std::int32_t>(time - other) < 0;
}

// The first of several future times; one that has passed counts as now.
class Soonest {
public:
  explicit Soonest(std::uint32_t now) : now_(now) {}

  // kNever: there is no such time.
  void at(std::uint32_t time) {
    if (time != kNever) surely_at(time);
  }
  // … of a time that was computed, and may be equal to kNever.
  void surely_at(std::uint32_t time) {
    delay_ = std::min(delay_, reached(time, now_) ? 0 : time - now_);
  }
  void in(std::uint32_t delay) { delay_ = std::min(delay_, delay); }
  std::uint32_t delay() const { return delay_; }  // milliseconds from now; kNever

private:
  std::uint32_t now_;
  std::uint32_t delay_ = kNever;
};

}  // namespace robosync::layers
