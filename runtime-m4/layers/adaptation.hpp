// Adaptive priorities of a program's threads. Counts how often each behaviour is triggered. At the end
// of each window, every thread gets the highest adapted priority of the behaviours that need it
// (policy/adaptation.hpp).
//
// Windows follow each other in program time from activation on, so host and board change ranks at
// the same tick. The step thread does it, before everything else at that tick except what outranks it.
// Only the order of threads changes. Ownership of actuators is decided by the written
// priorities (arbiter.hpp), however often anything was triggered.
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
  // Ends the window if `now` has reached its end: ranks change, and the trace reports each behaviour
  // whose priority changed, by behaviour.
  void turn(const LoadedProgram& program, ProgramThreads& threads, Trace& trace, std::uint32_t now);
  // When turn() has something to do; kNever while all are at their base and nothing was triggered.
  std::uint32_t next() const { return end_; }

  // Gives all threads their priorities, from the counts, and clears the counts. At first nothing was
  // counted, so each has its written priority. True if anything was counted.
  bool rank(const LoadedProgram& program, ProgramThreads& threads, Trace& trace);

private:
  static std::uint32_t end_after(const LoadedProgram& program, std::uint32_t now);

  std::span<policy::TriggerCount> triggers_;  // in this window
  std::uint32_t end_ = kNever;                // of this window
};

}  // namespace robosync::layers
