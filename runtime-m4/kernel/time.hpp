// Time in the kernel: microseconds since start-up, monotonic, never wraps in practice (2^64 us).
#pragma once

#include <cstdint>

namespace robosync::kernel {

using Time = std::uint64_t;      // a point in time, microseconds since start-up
using Duration = std::uint64_t;  // microseconds

inline constexpr Time kForever = ~Time{0};
inline constexpr Duration kTick = 1000;  // resolution of deadlines; now() is a multiple of it

constexpr Duration milliseconds(std::uint32_t ms) {
  return Duration{ms} * 1000;
}

}  // namespace robosync::kernel
