// Holds the behaviours' threads to their budget. The verifier has bounded what each can take in a
// step, so one that runs on and on runs something else: it is stopped, and the others go on.
//
// Looked at by the safety monitor, and only while the step thread makes no progress: the behaviour
// of highest rank that is ready is then the one that holds everything up. What counts is how long it
// ran by itself (Kernel::run_time()), so nobody pays for those that outrank him. Where time does
// not flow nothing is ever stopped.
#pragma once

#include <cstdint>

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::layers {

class Budget {
public:
  // Of one release of a behaviour, in counts of Kernel::clock(). The verifier's bound for a whole
  // step is in instructions: this gives each of them two cycles.
  explicit Budget(std::uint32_t step_budget) : counts_(2 * step_budget) {}

  // The behaviour's thread that is over its budget, or null.  [a thread that outranks all
  // behaviours]
  kernel::Thread* look(const kernel::Kernel& kernel);
  // All is well: what was seen is forgotten.
  void forget() { suspect_ = nullptr; }

private:
  std::uint32_t counts_;
  kernel::Thread* suspect_ = nullptr;
  std::uint32_t activations_ = 0;  // of the suspect, when it became one
  std::uint32_t run_time_ = 0;
};

}  // namespace robosync::layers
