// The limits of an actuator, applied to an order.
#pragma once

#include "runtime-m4/drivers/order.hpp"
#include "vm/image.hpp"

namespace robosync::layers {

// By value: the references of std::clamp would put all three on the stack.
constexpr vm::Value clamped(vm::Value value, vm::Value least, vm::Value most) {
  if (value < least) return least;
  return value > most ? most : value;
}

// Does an actuator's range or limit apply to one of its parameters?
constexpr bool has_limits(const drivers::Order& order) {
  return order.has(vm::Param::to) || order.has(vm::Param::at);
}

// Clamps the order's parameters to the actuator's range (TO) and limits (AT). One that is unknown stays so.
[[gnu::always_inline]] inline void limit(const vm::Actuator& actuator, drivers::Order& order) {
  using enum vm::Param;
  if (order.has(to) && order[to] != vm::kUnknown)
    order[to] = clamped(order[to], actuator.min, actuator.max);
  if (order.has(at) && order[at] != vm::kUnknown)
    order[at] = clamped(order[at], 0, actuator.speed_limit);
}

}  // namespace robosync::layers
