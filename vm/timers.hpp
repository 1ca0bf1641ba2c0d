// The time words: what a condition remembers from earlier steps.
//
// Each call evaluates one timer (image.hpp, TimerKind) at machine.now. Its state in the timer memory
// is 0 at the start of the program; any other content is harmless. Times are milliseconds that may
// wrap: only differences count, and no relevant difference exceeds the longest duration (24 days).
#pragma once

#include "vm/interpreter.hpp"

namespace robosync::vm {

// The result of the time word `word`. Lowers machine.wake to the time when it may change without new
// inputs, and sets machine.event if it is true for one step only.
[[nodiscard]] Value time_word(Machine& machine, Word word);

struct TimerInfo {
  std::uint8_t words;  // of timer memory; if it counts, one more for each edge
  bool counts;         // does it use Timer::count? If not, that is 0
};
inline constexpr std::array<TimerInfo, static_cast<std::size_t>(TimerKind::count_)> kTimers = {{
#define TIMER(name, words, counts, doc) {words, counts},
#include "vm/timers.def"
#undef TIMER
}};
constexpr const TimerInfo& info_of(TimerKind kind) {
  return kTimers[static_cast<std::size_t>(kind)];
}

// Words that a timer takes in the timer memory. The verifier must accept the timer.
constexpr unsigned timer_words(const Timer& timer) {
  return info_of(timer.kind).words + 0U + timer.count;
}

// Whether `now` is `time` or later.
constexpr bool reached(std::uint32_t time, std::uint32_t now) {
  return static_cast<std::int32_t>(now - time) >= 0;
}

// kNever is not a time: the millisecond after it is used instead, once in 49 days.
constexpr std::uint32_t as_time(std::uint32_t time) {
  return time == Machine::kNever ? 0 : time;
}

// Lowers machine.wake to `time`.
inline void wake_at(Machine& machine, std::uint32_t time) {
  const std::uint32_t told = as_time(time);
  const bool sooner = told - machine.now < machine.wake - machine.now;
  if (machine.wake == Machine::kNever || sooner) machine.wake = told;
}

}  // namespace robosync::vm
