// A hobby servo: a setpoint every 20 ms, pulses of 500 to 2500 us, or those of its image, over the range of the actuator. For how
// it moves see way.hpp.
#include <algorithm>

#include "runtime-m4/drivers/way.hpp"
#include "runtime-m4/policy/pulses.hpp"

namespace robosync::drivers::servo {
namespace {

constexpr vm::Value kDefaultSpeed = 90 * vm::kScale;  // thousandths of a degree a second

void output(const Device& device, kernel::Time now) {
  const vm::Value position =
      std::clamp(way::position(device, now), device.wiring.min, device.wiring.max);
  device.drive(policy::pulse_at(device.wiring, device.pulses(), position), now);
}

kernel::Time follow(const Device& device, kernel::Time now) {
  output(device, now);
  return std::min(device.state.motion.end(), now + way::kFrame);
}

}  // namespace

kernel::Time start(const Device& device, const Order& order, kernel::Time now) {
  if (!device.state.placed) way::stand_at_rest(device, now);
  if (order.action == vm::Action::stop) {
    if (way::brake(device, now)) return follow(device, now);
    release(device, vm::Release::hold, now);
    return kDone;
  }
  return way::start(device, order, kDefaultSpeed, now) ? follow(device, now) : kDone;
}

kernel::Time advance(const Device& device, kernel::Time now) {
  if (now < device.state.motion.end()) return follow(device, now);
  output(device, now);
  return way::next_leg(device, now) ? follow(device, now) : kDone;
}

void release(const Device& device, vm::Release how, kernel::Time now) {
  way::stop(device, how, now);
  if (how == vm::Release::coast) return device.drive(0, now);
  if (device.state.placed) output(device, now);  // else it was never driven: nothing to hold
}

}  // namespace robosync::drivers::servo
