// Adaptive priorities of a program's threads: counts how often each behaviour is triggered, and at
// the end of each window gives every thread the highest of what the behaviours that need it are
// worth now (policy/adaptation.hpp).
//
// Windows follow each other in program time from activation on, so host and board change ranks at
// the same tick: the step thread does it, before anything else at that tick but what outranks it.
// Only the order of threads changes. Who owns an actuator is decided by the priorities as they are
// written (arbiter.hpp), whatever was triggered how often.
#pragma once

#include <cstdint>
#include <span>

#include "runtime-m4/layers/clock.hpp"
#include "runtime-m4/layers/loaded_program.hpp"
#include "runtime-m4/layers/program_threads.hpp"
#include "runtime-m4/layers/trace.hpp"
#include "runtime-m4/policy/adaptation.hpp"

namespace robosync::layers {

class Adaptation {
public:
  void start(Memory& memory);
  // A rule of `behavior` triggered, at `now`.
  void count(const LoadedProgram& program, unsigned behavior, std::uint32_t now);
  // Ends the window if `now` has reached its end: ranks change, the trace tells of each behaviour
  // whose priority is another, by behaviour.
  void turn(const LoadedProgram& program, ProgramThreads& threads, Trace& trace, std::uint32_t now);
  // When turn() has something to do; kNever while all are at their base and nothing was triggered.
  std::uint32_t next() const { return end_; }

  // Gives all threads their priorities, from what was counted; at first nothing was, and each has
  // what is written. True if anything was counted; it is forgotten.
  bool rank(const LoadedProgram& program, ProgramThreads& threads, Trace& trace);

private:
  static std::uint32_t end_after(const LoadedProgram& program, std::uint32_t now);

  std::span<policy::TriggerCount> triggers_;  // in this window
  std::uint32_t end_ = kNever;                // of this window
};

}  // namespace robosync::layers
