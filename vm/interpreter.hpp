// Runs verified bytecode. The interpreter loop is interpreter.cpp; the opcodes are opcodes.def; the
// time words are timers.cpp.
//
// It trusts the verifier and does not check operands again. It never allocates, never recurses, and
// ends after at most the cost that the verifier has computed.
#pragma once

#include "vm/image.hpp"

namespace robosync::vm {

// The state that code needs to run. One per behaviour thread. `frame` must stay first: the
// interpreter's hot path loads the members in this order.
struct Machine {
  Value* frame = nullptr;            // inputs, locals, watched truths, registers
  const Value* constants = nullptr;  // the image's constants
  Word* output = nullptr;            // the next output word goes here
  const Word* output_end =
      nullptr;  // output words past it are dropped (the verifier proves that there are none)
  const Timer* timers = nullptr;          // the image's timers
  std::uint32_t* timer_memory = nullptr;  // their states; zero at the start of the program

  std::uint32_t now = 0;        // milliseconds of program time; set by the caller before each run
  std::uint32_t wake = kNever;  // lowered to the time when the result may change without new inputs
  std::uint32_t random = 1;     // state of the random numbers, never 0
  bool event = false;  // set when a condition is true for this step only (BECOMES, CHANGES …)
  bool divided_by_zero = false;  // set by a division by zero
  std::uint8_t left_ms = 0;  // `until` goes on this much later at the earliest, even if it is true
  // Bit a: the response has assigned, or shifted, input cell a. Cleared by the caller.
  std::uint32_t assigned = 0;
  std::uint32_t shifted = 0;

  [[nodiscard]] std::uint32_t written() const { return assigned | shifted; }

  static constexpr std::uint32_t kNever = 0xFFFFFFFF;
};

// Why a response paused, and when it continues.
enum class Pause : std::uint8_t {
  ended,
  until_time,     // at Progress::wake
  until_done,     // when all commands in its output are done
  polling,        // in every step that evaluates its behaviour, or at Progress::wake
  still_polling,  // like polling: `until` was not true, so it keeps polling
  satisfied,      // at Progress::wake: `until` was true before Machine::left_ms were over
  count_
};
struct Progress {
  Pause pause = Pause::ended;
  const Word* next = nullptr;            // where respond() continues; null when it has ended
  std::uint32_t wake = Machine::kNever;  // milliseconds of program time
};

// The interpreter's loop. Runs the object at `code`; returns the result of a condition. A response that
// pauses sets `progress`, which is null for a condition. For evaluate() and respond(), and for callers
// that need its address.
Value run(Machine& machine, const Word* code, Progress* progress);

// Evaluates the condition at `code`: kTrue, kFalse or kUnknown; for an EVERY rule, its period.
[[nodiscard]] inline Value evaluate(Machine& machine, const Word* code) {
  return run(machine, code, nullptr);
}

// Runs a response from `code` to its end, or until it waits. Its output is appended to
// machine.output: `arg`/`arg_k` words, each followed by the parameter's value, then the `cmd`,
// `cmd_end`, `log`, `alert` or `halt` word. OutputReader (output.hpp) reads them back. When it polls,
// Progress::wake includes machine.wake, which should be kNever before the call. Unknown and negative
// durations count as 0; a SET to an unknown value does nothing.
[[nodiscard]] inline Progress respond(Machine& machine, const Word* code) {
  Progress progress;
  (void)run(machine, code, &progress);
  return progress;
}

}  // namespace robosync::vm
