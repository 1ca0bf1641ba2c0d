// Runs verified bytecode. The interpreter loop is interpreter.cpp; the opcodes are opcodes.def; the
// time words are timers.cpp.
//
// It trusts the verifier: operands are not checked again. It never allocates, never recurses, and
// ends after at most the cost that the verifier has computed.
#pragma once

#include "vm/image.hpp"

namespace robosync::vm {

// What code needs to run. One per behaviour thread. `frame` stays first: the interpreter's hot path
// loads the members in this order.
struct Machine {
  Value* frame = nullptr;            // inputs, locals, watched truths, registers
  const Value* constants = nullptr;  // the image's constants
  Word* output = nullptr;            // where the next output word goes
  const Word* output_end =
      nullptr;  // output words beyond are dropped (the verifier proves there are none)
  const Timer* timers = nullptr;          // the image's timers
  std::uint32_t* timer_memory = nullptr;  // their states; zero at the start of the program

  std::uint32_t now = 0;        // milliseconds of program time; set by the caller before each run
  std::uint32_t wake = kNever;  // lowered to when the result may change without new inputs
  std::uint32_t random = 1;     // state of the random numbers, never 0
  bool event = false;  // set when a condition is true for this step only (BECOMES, CHANGES …)
  bool divided_by_zero = false;  // set when it happened
  // Bit a: input cell a was `set` by the response; it was shifted. Cleared by the caller.
  std::uint32_t assigned = 0;
  std::uint32_t shifted = 0;

  [[nodiscard]] std::uint32_t written() const { return assigned | shifted; }

  static constexpr std::uint32_t kNever = 0xFFFFFFFF;
};

// Why a response gave up the processor, and where it goes on.
enum class Pause : std::uint8_t {
  ended,
  until_time,     // at Progress::wake
  until_done,     // when all commands it has put out are done
  polling,        // in every step that evaluates its behaviour, or at Progress::wake
  still_polling,  // as polling: `until` was not true, so it goes on as it was
  count_
};
struct Progress {
  Pause pause = Pause::ended;
  const Word* next = nullptr;            // where respond() goes on; null when it ended
  std::uint32_t wake = Machine::kNever;  // milliseconds of program time
};

// The interpreter's loop. Runs the object at `code`; returns what a condition gives. When a
// response pauses, it says so in `progress`, which a condition has none of. For evaluate() and
// respond(), and for who must call it by its address.
Value run(Machine& machine, const Word* code, Progress* progress);

// Evaluates a condition starting at `code`: kTrue, kFalse or kUnknown; of an EVERY rule: its
// period.
[[nodiscard]] inline Value evaluate(Machine& machine, const Word* code) {
  return run(machine, code, nullptr);
}

// Runs a response from `code` to its end, or to where it waits. What it puts out is appended to
// machine.output: `arg`/`arg_k` words each followed by the parameter's value, then the `cmd`,
// `cmd_end`, `log`, `alert` or `halt` word. OutputReader (output.hpp) reads them back. Where it
// polls, Progress::wake takes machine.wake in: that should be kNever before the call. Durations
// that are unknown or negative are none; SETs to an unknown value do nothing.
[[nodiscard]] inline Progress respond(Machine& machine, const Word* code) {
  Progress progress;
  (void)run(machine, code, &progress);
  return progress;
}

}  // namespace robosync::vm
