// A hobby servo: a setpoint every 20 ms, pulses of 500 to 2500 us over the range of the actuator.
//
//   MOVE TO x, MOVE BY x    the way there, at AT, or in OVER
//   MOVE                    a gesture: to the range's end, to its beginning, and back to where
//                           it was
//
// Nothing tells where a servo stands when a program starts: it is taken to be at rest, which is 0
// or the end of the range next to it. A servo that is not to move (AT 0) has done so at once. OVER
// is stretched where it would need more than the actuator's speed limit.
#include <algorithm>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::drivers::servo {
namespace {

constexpr kernel::Duration kFrame = kernel::milliseconds(policy::kSetpointPeriodMs);
constexpr std::uint32_t kShortestPulse = 500;  // microseconds
constexpr std::uint32_t kPulseSpan = 2000;
constexpr vm::Value kDefaultSpeed = 90 * vm::kScale;  // thousandths of a degree a second
constexpr std::uint16_t kLegsOfGesture = 3;
constexpr vm::Value kMostGestures = 1000;

vm::Value rest_position(const vm::Actuator& wiring) {
  return std::clamp(vm::Value{0}, wiring.min, wiring.max);
}

void stand(Device device, vm::Value position, kernel::Time now) {
  device.state.motion = {.from = position, .to = position, .begin = now, .length = 0};
  device.state.legs = 0;
  device.state.placed = true;
}

void output(Device device, kernel::Time now) {
  const std::int64_t span = std::int64_t{device.wiring.max} - device.wiring.min;
  const vm::Value position =
      std::clamp(device.state.motion.at(now), device.wiring.min, device.wiring.max);
  const std::int64_t way = std::int64_t{position} - device.wiring.min;
  const std::int64_t pulse = span == 0 ? kPulseSpan / 2 : way * kPulseSpan / span;
  device.board.pwm_write(device.wiring.pin, kShortestPulse + static_cast<std::uint32_t>(pulse));
}

void begin_leg(Device device, vm::Value to, kernel::Duration length, kernel::Time now) {
  const vm::Value from = device.state.motion.at(now);
  device.state.motion = {
      .from = from, .to = to, .begin = now, .length = std::max<kernel::Duration>(length, kFrame)};
}

kernel::Time follow(Device device, kernel::Time now) {
  output(device, now);
  return std::min(device.state.motion.end(), now + kFrame);
}

vm::Value target_of(Device device, const Order& order, vm::Value position) {
  if (order.has(vm::Param::to)) return order.get(vm::Param::to, 0);
  const bool back = order.get(vm::Param::direction, 1) < 0;
  const std::int64_t by = order.get(vm::Param::by, 0);
  const std::int64_t target = position + (back ? -by : by);
  return static_cast<vm::Value>(
      std::clamp<std::int64_t>(target, device.wiring.min, device.wiring.max));
}

kernel::Time start_move(Device device, const Order& order, vm::Value speed, kernel::Time now) {
  const vm::Value position = device.state.motion.at(now);
  const vm::Value target = target_of(device, order, position);
  kernel::Duration length = travel_time(position, target, speed);
  if (order.has(vm::Param::over)) {
    length = std::max(duration_of(order.get(vm::Param::over, 0)),
                      travel_time(position, target, device.wiring.speed_limit));
  }
  if (length == kernel::kForever) return kDone;
  device.state.legs = 0;
  begin_leg(device, target, length, now);
  return follow(device, now);
}

// The order of the legs: to max, to min, home. `legs` counts down, so 3n is the first of a gesture.
vm::Value leg_target(Device device) {
  switch (device.state.legs % kLegsOfGesture) {
    case 0:
      return device.wiring.max;
    case 2:
      return device.wiring.min;
    default:
      return device.state.home;
  }
}

kernel::Time next_leg(Device device, kernel::Time now) {
  const vm::Value target = leg_target(device);
  --device.state.legs;
  begin_leg(device, target, travel_time(device.state.motion.at(now), target, device.state.speed),
            now);
  return follow(device, now);
}

// With OVER the gesture as a whole takes that long; the way of one is twice the range.
vm::Value gesture_speed(Device device, const Order& order, vm::Value speed) {
  const auto over = static_cast<std::int64_t>(duration_of(order.get(vm::Param::over, 0)));
  if (over == 0) return speed;
  const std::int64_t way = 2 * (std::int64_t{device.wiring.max} - device.wiring.min);
  return static_cast<vm::Value>(
      std::clamp<std::int64_t>(way * 1'000'000 / over, 1, device.wiring.speed_limit));
}

kernel::Time start_gesture(Device device, const Order& order, vm::Value speed, kernel::Time now) {
  if (speed <= 0 || device.wiring.min == device.wiring.max) return kDone;
  const vm::Value times = order.get(vm::Param::times, vm::kScale) / vm::kScale;
  const vm::Value bounded = std::clamp(times, vm::Value{1}, kMostGestures);
  device.state.home = device.state.motion.at(now);
  device.state.speed = gesture_speed(device, order, speed);
  device.state.legs = static_cast<std::uint16_t>(bounded * kLegsOfGesture);
  return next_leg(device, now);
}

}  // namespace

kernel::Time start(Device device, const Order& order, kernel::Time now) {
  if (!device.state.placed) stand(device, rest_position(device.wiring), now);
  if (order.action == vm::Action::stop) {
    release(device, vm::Release::hold, now);
    return kDone;
  }
  const vm::Value speed =
      order.get(vm::Param::at, std::min(kDefaultSpeed, device.wiring.speed_limit));
  const bool has_target = order.has(vm::Param::to) || order.has(vm::Param::by);
  return has_target ? start_move(device, order, speed, now)
                    : start_gesture(device, order, speed, now);
}

kernel::Time advance(Device device, kernel::Time now) {
  if (now < device.state.motion.end()) return follow(device, now);
  output(device, now);
  return device.state.legs == 0 ? kDone : next_leg(device, now);
}

void release(Device device, vm::Release how, kernel::Time now) {
  if (how == vm::Release::coast) {
    if (device.state.placed) stand(device, device.state.motion.at(now), now);
    device.board.pwm_write(device.wiring.pin, 0);
    return;
  }
  if (how == vm::Release::rest) stand(device, rest_position(device.wiring), now);
  if (!device.state.placed) return;  // it was never driven: there is nothing to hold
  stand(device, device.state.motion.at(now), now);
  output(device, now);
}

}  // namespace robosync::drivers::servo
