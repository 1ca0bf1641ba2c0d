// A linear motion from one value to another in a given time, in integers.
#pragma once

#include <algorithm>
#include <cstdint>

#include "runtime-m4/kernel/time.hpp"
#include "vm/value.hpp"

namespace robosync::drivers {

inline constexpr kernel::Duration kLongestMotion = kernel::milliseconds(INT32_MAX);

struct Motion {
  vm::Value from = 0;
  vm::Value to = 0;
  kernel::Time begin = 0;
  kernel::Duration length = 0;  // at most kLongestMotion

  kernel::Time end() const { return begin + length; }
  // Where it is at `now`: `from` before it begins, `to` from its end on.
  vm::Value at(kernel::Time now) const {
    if (now >= end()) return to;
    if (now <= begin) return from;
    const std::int64_t way = std::int64_t{to} - from;
    // In milliseconds the product fits: |way| < 2^32 and kLongestMotion is below 2^31 of them.
    const auto passed = static_cast<std::int64_t>((now - begin) / 1000);
    const auto whole = static_cast<std::int64_t>(length / 1000);
    return whole == 0 ? to : static_cast<vm::Value>(from + way * passed / whole);
  }
};

// How long the way takes at `speed` (thousandths per second), in microseconds, at most
// kLongestMotion; 0 if there is no way. With a speed of 0 or less it never arrives: kForever.
constexpr kernel::Duration travel_time(vm::Value from, vm::Value to, vm::Value speed) {
  const std::int64_t way = std::int64_t{to} - from;
  const auto distance = static_cast<std::uint64_t>(way < 0 ? -way : way);
  if (distance == 0) return 0;
  if (speed <= 0) return kernel::kForever;
  return std::min(distance * 1'000'000 / static_cast<std::uint64_t>(speed), kLongestMotion);
}

}  // namespace robosync::drivers
