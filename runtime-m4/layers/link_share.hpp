// Decides when the step thread waits, between two passes, for the link's thread, which ranks below the whole program: when that
// thread has been ready for a given time (its patience) without getting time, and has budget (policy/link_share.hpp).
//
// It has had time if it blocked, which starts a new activation, or if it ran for its part of the time. After a turn it has no
// budget for kLinkParts times the length of that turn. Where time does not flow, as in a simulation, it gets no turn.
#pragma once

#include <cstdint>

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::layers {

class LinkShare {
public:
  // A look at the thread. Most turns are shorter than a tick, so they are measured by the clock. All of these wrap.
  struct Look {
    std::uint32_t tick = 0;
    std::uint32_t clock = 0;
    std::uint32_t activations = 0;
    std::uint32_t run_time = 0;  // in counts of the clock
  };

  // Names the link's thread. Before Kernel::run().
  void watch(const kernel::Thread& link) { link_ = &link; }
  // A program begins, with steps of this cost. The link is not waiting yet, and its budget is full.
  void start(std::uint32_t step_cost);

  // Between two passes: does the link's thread have work?
  bool is_wanted(const kernel::Kernel& kernel) const {
    return link_ != nullptr && kernel.is_ready(*link_);
  }
  Look look(const kernel::Kernel& kernel) const;
  // … and is it due for a turn?
  bool is_due(const Look& look);
  // The turn took from `begin` to `end`.
  void took(const Look& begin, const Look& end);

private:
  bool had_time(const Look& look) const;
  bool has_budget(const Look& look) const;

  const kernel::Thread* link_ = nullptr;
  std::uint32_t patience_ = 0;  // ticks
  Look since_;                  // when it was first seen waiting
  Look turn_;                   // when its last turn began …
  std::uint32_t pause_ = 0;  // … and for how long after that it gets none, in counts of the clock
};

}  // namespace robosync::layers
