// The MPU's eight regions. Where two overlap, the higher number counts.
//
//   0     memory, 0 … 1 GB                  privileged only, never executed
//   1     code, 0 … 256 MB                  all read and execute, nobody writes; RAM may begin behind it
//   2     Areas::readable                   … and read by others
//   3, 4  Areas::writable                   … and written by others
//   5, 6  stack of a thread without privileges, while it runs (later ones leave it as it was, which
//         tells those with privileges nothing new); of a secluded one, 5 closes all RAM and 6 is its stack;
//         of a sandbox (sandbox.hpp), its window
//   7     guard below the stack of a thread with privileges, while it runs: nobody
//
// What no region covers is as without an MPU to privileged code (peripherals, external RAM), and
// closed to others. So a thread without privileges has no address that is not listed here.
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

// For the base register.
constexpr std::uint32_t base_of(RegionNumber number, std::uint32_t base) {
  return base | core::kMpuBaseValid | static_cast<std::uint32_t>(number);
}

// Switches the MPU on, with regions 0, 1 and 7. [init]
void start_isolation();

}  // namespace robosync::port
