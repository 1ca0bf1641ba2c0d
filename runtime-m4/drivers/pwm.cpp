// Duty cycle in percent of the 20 ms frame, on a PWM pin. TO or AT sets it, OVER goes there evenly;
// FOR keeps it on for a time and then switches off. Without FOR it stays. With neither TO nor AT: full. The range applies to
// all of these, and so does the SPEED limit.
#include <algorithm>

#include "runtime-m4/drivers/power.hpp"

namespace robosync::drivers::pwm {
namespace {

void output(const Device& device, kernel::Time now) {
  const vm::Value percent = std::clamp(device.state.motion.at(now), vm::Value{0}, power::kFull);
  device.drive(static_cast<std::uint32_t>(percent / power::kStep), now);
}

vm::Value level_of(const Device& device, const Order& order) {
  const vm::Actuator& wiring = device.wiring;
  const vm::Value wanted = order.get(vm::Param::to, order.get(vm::Param::at, power::kFull));
  return std::min(std::clamp(wanted, wiring.min, wiring.max), wiring.speed_limit);
}

}  // namespace

kernel::Time start(const Device& device, const Order& order, kernel::Time now) {
  power::begin(device, order, level_of(device, order), now);
  return advance(device, now);
}

kernel::Time advance(const Device& device, kernel::Time now) {
  const kernel::Time due = power::advance(device, now);
  output(device, now);
  return due;
}

void release(const Device& device, vm::Release how, kernel::Time now) {
  power::stop(device, how, now);
  output(device, now);
}

}  // namespace robosync::drivers::pwm
