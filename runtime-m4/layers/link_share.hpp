// When the step thread waits for the link's thread, which ranks below the whole program, between two passes: when that has had
// something to do for so long and no time for it, and has its budget (policy/link_share.hpp).
//
// It has had time when it came to an end, which activates it anew, or ran for its part of the time. After a turn it has no budget
// for kLinkParts times what that took. Where time does not flow, as in a simulation, no turn comes.
#pragma once

#include <cstdint>

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::layers {

class LinkShare {
public:
  // How the thread stands. Most turns are shorter than a tick: they are counted by the clock. All of these wrap.
  struct Look {
    std::uint32_t tick = 0;
    std::uint32_t clock = 0;
    std::uint32_t activations = 0;
    std::uint32_t run_time = 0;  // in counts of the clock
  };

  // Whose share it is. Before Kernel::run().
  void watch(const kernel::Thread& link) { link_ = &link; }
  // A program begins whose steps cost so much: nobody has waited, and the budget is full.
  void start(std::uint32_t step_cost);

  // Between two passes: has it something to do?
  bool is_wanted(const kernel::Kernel& kernel) const {
    return link_ != nullptr && kernel.state(*link_) == kernel::Thread::State::ready;
  }
  Look look(const kernel::Kernel& kernel) const;
  // … and is it its turn?
  bool is_due(const Look& look);
  // That turn was from `begin` to `end`.
  void took(const Look& begin, const Look& end);

private:
  bool had_time(const Look& look) const;
  bool has_budget(const Look& look) const;

  const kernel::Thread* link_ = nullptr;
  std::uint32_t patience_ = 0;  // ticks
  Look since_;                  // when it was first seen to wait
  Look turn_;                   // when its last one began …
  std::uint32_t pause_ = 0;     // … and how long from there there is none, in counts of the clock
};

}  // namespace robosync::layers
