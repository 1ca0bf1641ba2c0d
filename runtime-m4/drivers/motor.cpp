// A motor on an H-bridge: power in percent of the 20 ms frame, in one direction on its pin, in the other on its second pin. The
// sign of TO is the direction; AT, or full power if neither is given, goes forward. BACKWARD reverses either. OVER goes there
// evenly, through a standstill if the direction changes. The range applies to AT too, the SPEED limit to both.
#include <algorithm>

#include "runtime-m4/drivers/power.hpp"

namespace robosync::drivers::motor {
namespace {

void output(const Device& device, kernel::Time now) {
  const vm::Value percent = std::clamp(device.state.motion.at(now), -power::kFull, power::kFull);
  device.drive_either(percent / power::kStep, now);
}

vm::Value level_of(const Device& device, const Order& order) {
  const vm::Actuator& wiring = device.wiring;
  const vm::Value said = order.get(vm::Param::to, order.get(vm::Param::at, power::kFull));
  const vm::Value wanted = order.get(vm::Param::direction, 1) < 0 ? -said : said;
  const vm::Value most = std::min(wiring.speed_limit, power::kFull);
  return std::clamp(std::clamp(wanted, wiring.min, wiring.max), -most, most);
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

}  // namespace robosync::drivers::motor
