// See way.hpp.
#include "runtime-m4/drivers/way.hpp"

#include <algorithm>

#include "runtime-m4/policy/pulses.hpp"

namespace robosync::drivers::way {
namespace {

constexpr std::uint16_t kLegsOfGesture = 3;
constexpr vm::Value kMostGestures = 1000;

void begin_leg(const Device& device, vm::Value to, kernel::Duration length, kernel::Time now) {
  const vm::Value from = device.state.motion.at(now);
  device.state.motion = {
      .from = from, .to = to, .begin = now, .length = std::max<kernel::Duration>(length, kFrame)};
}

bool start_move(const Device& device, const Order& order, vm::Value speed, kernel::Time now) {
  const vm::Value position = device.state.motion.at(now);
  const vm::Value target = target_of(device, order, now);
  kernel::Duration length = travel_time(position, target, speed);
  if (order.has(vm::Param::over)) {
    length = std::max(duration_of(order.get(vm::Param::over, 0)),
                      travel_time(position, target, device.wiring.speed_limit));
  }
  if (length == kernel::kForever) return false;
  device.state.legs = 0;
  begin_leg(device, target, length, now);
  return true;
}

// The order of the legs: to max, to min, home. `legs` counts down, so 3n is the first of a gesture.
vm::Value leg_target(const Device& device) {
  switch (device.state.legs % kLegsOfGesture) {
    case 0:
      return device.wiring.max;
    case 2:
      return device.wiring.min;
    default:
      return device.state.home;
  }
}

// With OVER the whole gesture takes that long; its way is twice the range.
vm::Value gesture_speed(const Device& device, const Order& order, vm::Value speed) {
  const auto over = static_cast<std::int64_t>(duration_of(order.get(vm::Param::over, 0)));
  if (over == 0) return speed;
  const std::int64_t way = 2 * (std::int64_t{device.wiring.max} - device.wiring.min);
  return static_cast<vm::Value>(
      std::clamp<std::int64_t>(way * 1'000'000 / over, 1, device.wiring.speed_limit));
}

bool start_gesture(const Device& device, const Order& order, vm::Value speed, kernel::Time now) {
  if (speed <= 0 || device.wiring.min == device.wiring.max) return false;
  const vm::Value times = order.get(vm::Param::times, vm::kScale) / vm::kScale;
  const vm::Value bounded = std::clamp(times, vm::Value{1}, kMostGestures);
  device.state.home = device.state.motion.at(now);
  device.state.speed = gesture_speed(device, order, speed);
  device.state.legs = static_cast<std::uint16_t>(bounded * kLegsOfGesture);
  return next_leg(device, now);
}

}  // namespace

void stand(const Device& device, vm::Value position, kernel::Time now) {
  device.state.motion = {.from = position, .to = position, .begin = now, .length = 0};
  device.state.legs = 0;
  device.state.placed = true;
}

void stand_at_rest(const Device& device, kernel::Time now) {
  stand(device, policy::rest_position(device.wiring), now);
}

void stop(const Device& device, vm::Release how, kernel::Time now) {
  if (how == vm::Release::rest) return stand_at_rest(device, now);
  if (device.state.placed) stand(device, device.state.motion.at(now), now);
}

bool has_target(const Order& order) {
  return order.has(vm::Param::to) || order.has(vm::Param::by);
}

vm::Value target_of(const Device& device, const Order& order, kernel::Time now) {
  if (order.has(vm::Param::to)) return order.get(vm::Param::to, 0);
  const bool back = order.get(vm::Param::direction, 1) < 0;
  const std::int64_t by = order.get(vm::Param::by, 0);
  const std::int64_t target = device.state.motion.at(now) + (back ? -by : by);
  return static_cast<vm::Value>(
      std::clamp<std::int64_t>(target, device.wiring.min, device.wiring.max));
}

bool start(const Device& device, const Order& order, vm::Value usual, kernel::Time now) {
  if (!device.state.placed) stand_at_rest(device, now);
  const vm::Value speed = order.get(vm::Param::at, std::min(usual, device.wiring.speed_limit));
  return has_target(order) ? start_move(device, order, speed, now)
                           : start_gesture(device, order, speed, now);
}

bool next_leg(const Device& device, kernel::Time now) {
  const vm::Value here = device.state.motion.at(now);
  // A gesture that begins at an end of the range is already there.
  if (device.state.legs != 0 && leg_target(device) == here) --device.state.legs;
  if (device.state.legs == 0) return false;
  const vm::Value target = leg_target(device);
  --device.state.legs;
  begin_leg(device, target, travel_time(here, target, device.state.speed), now);
  return true;
}

}  // namespace robosync::drivers::way
