// When the step thread waits for the link between two passes (policy/link_share.hpp): when a request has waited for so long, or
// when the link had nothing for a period (link_share.hpp). One budget for both: after a turn there is none for kLinkParts
// times what it took.
//
// Where time does not flow, as in a simulation, no turn is over.
#pragma once

#include <atomic>
#include <cstdint>

#include "runtime-m4/kernel/time.hpp"

namespace robosync::layers {

class LinkTurns {
public:
  // The kernel's time is one of ticks, and most turns are shorter: those are counted by the processor's clock.
  struct Now {
    kernel::Time time = 0;    // Kernel::now()
    std::uint32_t clock = 0;  // Kernel::clock(), which wraps
  };

  // Of a program whose steps cost so much: nobody has asked, and the budget is full.
  void start(std::uint32_t step_cost);

  // The link has something to do: the line has brought bytes, or takes some again.  [interrupt]
  void ask() { asked_.store(asked() + 1, std::memory_order_relaxed); }
  std::uint32_t asked() const { return asked_.load(std::memory_order_relaxed); }
  // It has done what it was asked until then.  [the link's thread]
  void has_heard(std::uint32_t asked) { heard_.store(asked, std::memory_order_relaxed); }
  bool waits() const { return asked() != heard(); }

  // Between two passes, when waits().
  bool is_time(const Now& now);
  bool has_budget(const Now& now) const;
  // A turn was from `begin` to `end`.
  void took(const Now& begin, const Now& end);

private:
  std::uint32_t heard() const { return heard_.load(std::memory_order_relaxed); }

  std::atomic<std::uint32_t> asked_ = 0;
  std::atomic<std::uint32_t> heard_ = 0;
  std::uint32_t heard_before_ = 0;  // when it was first seen to wait …
  kernel::Time since_ = 0;          // … which was then
  kernel::Duration patience_ = 0;
  Now last_;                 // turn's begin
  std::uint32_t pause_ = 0;  // from there, in counts of the clock
};

}  // namespace robosync::layers
