// See order.hpp.
#include "runtime-m4/layers/order.hpp"

#include <algorithm>

namespace robosync::layers {

using vm::Param;

namespace {

// By value: std::clamp's references put all three on the stack.
constexpr vm::Value clamped(vm::Value value, vm::Value least, vm::Value most) {
  if (value < least) return least;
  return value > most ? most : value;
}

[[gnu::always_inline]] inline vm::Value within(const vm::Actuator& actuator, Param param,
                                               vm::Value value) {
  if (value == vm::kUnknown) return value;
  if (param == Param::to) return clamped(value, actuator.min, actuator.max);
  if (param == Param::at) return clamped(value, 0, actuator.speed_limit);
  return value;
}

}  // namespace

bool resolve(const vm::Actuator& actuator, const Command& command, drivers::Order& order) {
  order.action = command.action();
  order.given = command.known();
  bool is_known = true;
  each_bit(command.known(), [&](unsigned p) {
    const vm::Value value = within(actuator, static_cast<Param>(p), command.param(p));
    order.params[p] = value;
    is_known &= value != vm::kUnknown;
  });
  return is_known;
}

void limit(const vm::Actuator& actuator, drivers::Order& order) {
  each_bit(order.given, [&](unsigned p) {
    order.params[p] = within(actuator, static_cast<Param>(p), order.params[p]);
  });
}

vm::Value limited(const vm::Actuator& actuator, Param param, vm::Value value) {
  return within(actuator, param, value);
}

}  // namespace robosync::layers
