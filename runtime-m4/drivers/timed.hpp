// Shared by drivers whose commands take time but move nothing.
#pragma once

#include <algorithm>

#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers {

inline constexpr kernel::Duration kDefaultDuration = kernel::milliseconds(1000);

// Done after FOR, or else OVER, or else kDefaultDuration. STOP and follow are done immediately.
inline kernel::Time take_time(const Device& device, const Order& order, kernel::Time now) {
  if (order.action == vm::Action::stop || order.action == vm::Action::follow) return kDone;
  kernel::Duration length = kDefaultDuration;
  if (order.has(vm::Param::over)) length = duration_of(order.get(vm::Param::over, 0));
  if (order.has(vm::Param::for_)) length = duration_of(order.get(vm::Param::for_, 0));
  if (length == 0) return kDone;
  device.state.until = now + length;
  return device.state.until;
}

inline kernel::Time go_on(const Device& device, kernel::Time now) {
  return now >= device.state.until ? kDone : device.state.until;
}

}  // namespace robosync::drivers
