// How long a BLINK takes, on real lights and on virtual ones.
#pragma once

#include <algorithm>

#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers {

inline constexpr vm::Value kMostBlinks = 1000;
inline constexpr kernel::Duration kBlink = kernel::milliseconds(150);  // one dark and one lit leg
inline constexpr kernel::Duration kShortestBlink = kernel::milliseconds(20);

// A blink has two legs.
struct Blink {
  unsigned legs;
  kernel::Duration leg;
};

// TIMES blinks, all within OVER.
inline Blink blink_of(const Order& order) {
  const vm::Value times = order.get(vm::Param::times, vm::kScale) / vm::kScale;
  const auto legs = static_cast<unsigned>(2 * std::clamp(times, vm::Value{1}, kMostBlinks));
  const kernel::Duration over = duration_of(order.get(vm::Param::over, 0));
  if (over == 0) return {legs, kBlink};
  return {legs, std::clamp<kernel::Duration>(over / legs, kShortestBlink, INT32_MAX)};
}

}  // namespace robosync::drivers
