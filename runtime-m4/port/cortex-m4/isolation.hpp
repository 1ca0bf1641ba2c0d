// The MPU's eight regions. Where two overlap, the higher number applies.
//
//   0     memory, 0 … 1 GB                  privileged access only, never executable
//   1     code, 0 … 256 MB                  read-only and executable for all; RAM may begin after it
//   2     Areas::readable                   unprivileged threads may read it
//   3, 4  Areas::writable                   unprivileged threads may read and write it
//   5, 6  stack of the running unprivileged thread (privileged threads leave it open, which gives them
//         no new access); for a secluded thread, 5 closes all RAM and 6 is its stack; for a sandbox
//         (sandbox.hpp), its window
//   7     guard below the stack of the running privileged thread: no access
//
// Where no region applies, privileged code has access as without an MPU (peripherals, external RAM),
// and unprivileged code has none. So an unprivileged thread can access only what is listed here.
#pragma once

#include <cstdint>

#include "runtime-m4/policy/regions.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"

namespace robosync::port {

enum class RegionNumber : std::uint8_t {
  memory,
  code,
  readable,
  writable,
  writable_upper,
  stack,
  stack_upper,
  guard
};

// The value of the MPU's base register.
constexpr std::uint32_t base_of(RegionNumber number, std::uint32_t base) {
  return base | core::kMpuBaseValid | static_cast<std::uint32_t>(number);
}

// Turns the MPU on, with regions 0, 1 and 7. [init]
void start_isolation();

}  // namespace robosync::port
