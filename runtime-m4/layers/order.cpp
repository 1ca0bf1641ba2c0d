// See order.hpp.
#include "runtime-m4/layers/order.hpp"

#include <algorithm>

namespace robosync::layers {

using vm::Param;

namespace {

// By value: the references of std::clamp would put all three on the stack.
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

void resolve(const vm::Actuator& actuator, const Command& command, QueuedOrder& queued) {
  const bool is_limited = command.action() != vm::Action::perform;
  queued.order.action = command.action();
  queued.order.given = command.known();
  queued.verb = command.verb();
  queued.word = command.word();
  queued.given = command.given();
  bool complete = true;
  each_bit(command.known(), [&](unsigned p) {
    vm::Value value = command.param(p);
    if (is_limited) value = within(actuator, static_cast<Param>(p), value);
    queued.order.params[p] = value;
    complete &= value != vm::kUnknown;
  });
  queued.complete = complete;
}

void limit(const vm::Actuator& actuator, drivers::Order& order) {
  each_bit(order.given, [&](unsigned p) {
    order.params[p] = within(actuator, static_cast<Param>(p), order.params[p]);
  });
}

}  // namespace robosync::layers
