// Enforces the budget of the behaviours' threads. The verifier has bounded what each can take in a
// step, so a behaviour that runs on and on is running something else: it is stopped, and the others go on.
//
// The safety monitor calls this, and only while the step thread makes no progress: the ready behaviour
// of the highest rank is then the one that blocks progress. Only its own run time counts
// (Kernel::run_time()), so no behaviour pays for those that outrank it. Where time does not flow,
// nothing is ever stopped.
#pragma once

#include <cstdint>

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::layers {

class Budget {
public:
  // For one release of a behaviour, in counts of Kernel::clock(). The verifier's bound for a whole step
  // is in instructions; this allows two cycles for each of them.
  explicit Budget(std::uint32_t step_budget) : counts_(2 * step_budget / port::kCyclesPerCount) {}

  // The behaviour's thread that is over its budget, or null.  [a thread that outranks all
  // behaviours]
  kernel::Thread* look(const kernel::Kernel& kernel);
  // The step thread makes progress: forgets the suspect.
  void forget() { suspect_ = nullptr; }

private:
  std::uint32_t counts_;
  kernel::Thread* suspect_ = nullptr;
  std::uint32_t activations_ = 0;  // of the suspect, when it became one
  std::uint32_t run_time_ = 0;
};

}  // namespace robosync::layers
