// The time words: what a condition remembers of the steps before.
//
// Each call is one evaluation of one timer (image.hpp, TimerKind) at machine.now. Its state in the
// timer memory is 0 at the start of the program; any other content is harmless. Times are
// milliseconds that may wrap: only differences count, and no difference that matters is longer than
// a duration can be (24 days).
#pragma once

#include "vm/interpreter.hpp"

namespace robosync::vm {

// What the instruction `word`, one of the time words, gives. Lowers machine.wake to the time when
// that may change without new inputs, and sets machine.event where it is true for one step only.
[[nodiscard]] Value time_word(Machine& machine, Word word);

// Words that a timer of this kind takes up in the timer memory.
constexpr unsigned timer_words(TimerKind kind, unsigned count) {
  if (kind == TimerKind::counted) return count + 1;
  return kind == TimerKind::sequence ? 2 : 1;
}

// `now` is `time`, or later.
constexpr bool reached(std::uint32_t time, std::uint32_t now) {
  return static_cast<std::int32_t>(now - time) >= 0;
}

// Lowers machine.wake to `time`.
inline void wake_at(Machine& machine, std::uint32_t time) {
  const std::uint32_t told = time == Machine::kNever ? 0 : time;  // 1 ms late, once in 49 days
  const bool sooner = told - machine.now < machine.wake - machine.now;
  if (machine.wake == Machine::kNever || sooner) machine.wake = told;
}

}  // namespace robosync::vm
