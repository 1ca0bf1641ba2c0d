// See order.hpp.
#include "runtime-m4/layers/order.hpp"

#include <algorithm>

namespace robosync::layers {

using vm::Param;

drivers::Order resolve(const vm::Actuator& actuator, const Command& command) {
  drivers::Order order;
  order.action = command.action();
  order.given = command.known();
  each_bit(command.known(), [&](unsigned p) { order.params[p] = command.param(p); });
  limit(actuator, order);
  return order;
}

void limit(const vm::Actuator& actuator, drivers::Order& order) {
  each_bit(order.given, [&](unsigned p) {
    order.params[p] = limited(actuator, static_cast<Param>(p), order.params[p]);
  });
}

vm::Value limited(const vm::Actuator& actuator, Param param, vm::Value value) {
  if (value == vm::kUnknown) return value;
  if (param == Param::to) return std::clamp(value, actuator.min, actuator.max);
  if (param == Param::at) return std::clamp(value, vm::Value{0}, actuator.speed_limit);
  return value;
}

bool is_void(const drivers::Order& order) {
  bool unknown = false;
  each_bit(order.given, [&](unsigned p) { unknown |= order.params[p] == vm::kUnknown; });
  return unknown;
}

}  // namespace robosync::layers
