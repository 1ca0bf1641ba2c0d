// Sees when the program has left the link's thread nothing of the processor for a period, and it is its turn
// (policy/link_share.hpp).
//
// Looked at by the safety thread with each check of a program. Between two checks the link had nothing when its thread could
// run at both, has not come to an end in between, and has run for less than its part of that time. Where time does not flow
// that never is so.
#pragma once

#include <cstdint>

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::layers {

class LinkShare {
public:
  // How the thread stands at a check at which it could run.
  struct Look {
    std::uint32_t activations = 0;
    std::uint32_t run_time = 0;  // both in counts of Kernel::clock(), and both wrap
    std::uint32_t clock = 0;
  };

  void watch(const kernel::Thread& link) { link_ = &link; }
  // At each check: is it the link's turn?  [a thread that outranks the program]
  bool is_due(const kernel::Kernel& kernel);
  // … at each at which its thread could run.
  bool is_due(const Look& look);

private:
  bool had_nothing(const Look& look) const;

  const kernel::Thread* link_ = nullptr;
  Look last_{.activations = UINT32_MAX};  // that is, none yet
  unsigned without_ = 0;                  // times between two checks, in a row
};

}  // namespace robosync::layers
