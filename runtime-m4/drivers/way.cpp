// See way.hpp.
//
// With a limit of acceleration, ActuatorState::speed has two more uses. Below 0 it is the time of the leg to come, in milliseconds.
// While the actuator stands it is the signed speed that it had when it was stopped: a command that replaces another one stops it
// first, at the same time, and then goes on from that speed.
#include "runtime-m4/drivers/way.hpp"

#include <algorithm>

#include "runtime-m4/drivers/trapezoid.hpp"
#include "runtime-m4/policy/pulses.hpp"

namespace robosync::drivers::way {
namespace {

constexpr std::uint16_t kLegsOfGesture = 3;
constexpr vm::Value kMostGestures = 1000;
// Less than a period of the safety monitor: after a halt a movement begins from a standstill.
constexpr kernel::Duration kTakeover = kernel::milliseconds(policy::kSafetyPeriodMs / 2);
constexpr std::uint64_t kFrameMs = policy::kSetpointPeriodMs;

bool has_ramps(const Device& device) {
  return device.state.acceleration != 0;
}

std::uint32_t distance(vm::Value from, vm::Value to) {
  return static_cast<std::uint32_t>(to > from ? std::int64_t{to} - from : std::int64_t{from} - to);
}

// The profile of the movement under way.
trapezoid::Profile profile_of(const ActuatorState& state) {
  return {state.ramp, state.motion.length / 1000};
}

std::uint64_t passed(const ActuatorState& state, kernel::Time now) {
  return now <= state.motion.begin ? 0 : (now - state.motion.begin) / 1000;
}

// Thousandths per second, below 0 if it goes backwards.
std::int64_t velocity(const ActuatorState& state, kernel::Time now) {
  const Motion& motion = state.motion;
  if (state.ramp == 0)
    return motion.length == 0 && now - motion.begin < kTakeover ? state.speed : 0;
  if (now >= motion.end()) return 0;
  const auto speed = static_cast<std::int64_t>(
      trapezoid::speed_at(distance(motion.from, motion.to), profile_of(state), passed(state, now)));
  return motion.to > motion.from ? speed : -speed;
}

// How it goes so far: at `pace`, which is a speed above 0, or a time in milliseconds, negated.
trapezoid::Profile plan(const Device& device, std::uint32_t way, std::int64_t pace) {
  const std::uint32_t acceleration = device.state.acceleration;
  const vm::Value speed = pace > 0 ? static_cast<vm::Value>(pace) : device.wiring.speed_limit;
  trapezoid::Profile profile =
      trapezoid::shortest(way, std::max(speed, vm::Value{1}), acceleration);
  const auto length = static_cast<std::uint64_t>(pace < 0 ? -pace : 0);
  if (length > profile.length) return trapezoid::stretched(way, length, acceleration);
  profile.length = std::max(profile.length, kFrameMs);
  return profile;
}

void set_off(const Device& device, vm::Value from, vm::Value to, const trapezoid::Profile& profile,
             kernel::Time begin) {
  device.state.motion = {.from = from, .to = to, .begin = begin, .length = profile.length * 1000};
  device.state.ramp = static_cast<std::uint16_t>(profile.ramp);
}

// It has been moving for as long as it takes to reach its present speed.
[[gnu::noinline]] std::uint64_t time_since_rest(const Device& device, std::int64_t velocity,
                                                kernel::Time now) {
  const auto speed = static_cast<std::uint64_t>(velocity < 0 ? -velocity : velocity);
  return std::min<std::uint64_t>(trapezoid::ramp_to(speed, device.state.acceleration), now / 1000);
}

// Goes on from `here` to `target` at its present speed: the rest of a movement that began some time ago, that far away that this
// is its speed and its position now. False if it cannot.
[[gnu::noinline]] bool go_on_to(const Device& device, vm::Value here, vm::Value target,
                                vm::Value pace, std::int64_t velocity, kernel::Time now) {
  if ((target > here) != (velocity > 0) || target == here) return false;
  const std::uint64_t before = time_since_rest(device, velocity, now);
  const std::uint64_t left = distance(here, target);
  const std::uint64_t most =
      left + trapezoid::rounded_up(device.state.acceleration * before * before, 2000);
  if (most > UINT32_MAX) return false;
  const std::int64_t total = pace < 0 ? pace - static_cast<std::int64_t>(before) : pace;
  const trapezoid::Profile profile = plan(device, static_cast<std::uint32_t>(most), total);
  if (before > profile.ramp) return false;
  // The part of the way before `now` is before² / (2 * R * C) of the whole.
  const std::uint64_t all = 2 * profile.ramp * (profile.length - profile.ramp);
  const auto way =
      static_cast<std::int64_t>(left + left * before * before / (all - before * before));
  const std::int64_t from = target > here ? target - way : target + way;
  if (from < vm::kValueMin || from > vm::kValueMax) return false;
  set_off(device, static_cast<vm::Value>(from), target, profile, now - before * 1000);
  return true;
}

// `way`, or less where the limits of position leave no room.
[[gnu::noinline]] vm::Value within_room(const Device& device, vm::Value here, bool forward,
                                        std::uint64_t way) {
  const vm::Value end = forward ? device.wiring.max : device.wiring.min;
  const std::uint32_t room = (end > here) == forward ? distance(here, end) : 0;
  const std::uint32_t behind =
      forward ? distance(vm::kValueMin, here) : distance(here, vm::kValueMax);
  return static_cast<vm::Value>(std::min<std::uint64_t>(way, std::min(room, behind)));
}

// From `here` on: the second half of a triangle. Where its limits of position leave no room, the actuator stops there.
[[gnu::noinline]] void slow_down(const Device& device, vm::Value here, std::int64_t velocity,
                                 kernel::Time now) {
  const bool forward = velocity > 0;
  const std::uint64_t ramp = time_since_rest(device, velocity, now);
  const auto speed = static_cast<std::uint64_t>(forward ? velocity : -velocity);
  const vm::Value ahead = within_room(device, here, forward, speed * ramp / 2000);
  const vm::Value way = forward ? ahead : -ahead;
  set_off(device, here - way, here + way, {ramp, 2 * ramp}, now - ramp * 1000);
}

void begin_leg(const Device& device, vm::Value from, vm::Value to, kernel::Duration length,
               kernel::Time now) {
  device.state.motion = {
      .from = from, .to = to, .begin = now, .length = std::max<kernel::Duration>(length, kFrame)};
}

[[gnu::noinline]] void begin_ramps(const Device& device, vm::Value to, std::int64_t pace,
                                   kernel::Time now) {
  const vm::Value from = position(device, now);
  set_off(device, from, to, plan(device, distance(from, to), pace), now);
}

// Brakes first if it must: then the way is the leg that follows.
[[gnu::noinline]] bool start_with_ramps(const Device& device, const Order& order, vm::Value speed,
                                        kernel::Time now) {
  const bool is_timed = order.has(vm::Param::over);
  if (!is_timed && speed <= 0) return brake(device, now);
  const vm::Value target = target_of(device, order, now);
  vm::Value pace = is_timed ? -std::max(order.get(vm::Param::over, 0), vm::Value{0}) : speed;
  const std::int64_t present = velocity(device.state, now);
  const vm::Value here = position(device, now);
  device.state.legs = 0;
  if (present == 0) {
    begin_ramps(device, target, pace, now);
  } else if (!go_on_to(device, here, target, pace, present, now)) {
    slow_down(device, here, present, now);
    if (pace < 0)
      pace = std::min(pace + static_cast<vm::Value>((device.state.motion.end() - now) / 1000),
                      vm::Value{0});
    device.state.home = target;
    device.state.speed = pace;
    device.state.legs = 1;
  }
  return true;
}

[[gnu::noinline]] bool start_move(const Device& device, const Order& order, vm::Value speed,
                                  kernel::Time now) {
  const vm::Value position = device.state.motion.at(now);
  const vm::Value target = target_of(device, order, now);
  kernel::Duration length = travel_time(position, target, speed);
  if (order.has(vm::Param::over)) {
    length = std::max(duration_of(order.get(vm::Param::over, 0)),
                      travel_time(position, target, device.wiring.speed_limit));
  }
  if (length == kernel::kForever) return false;
  device.state.legs = 0;
  begin_leg(device, position, target, length, now);
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

std::int64_t way_of_gesture(const Device& device) {
  return 2 * (std::int64_t{device.wiring.max} - device.wiring.min);
}

// So that all the legs together take `time` milliseconds: each takes as long as its way at the speed, and a ramp.
[[gnu::noinline]] std::int64_t speed_with_ramps(const Device& device, std::uint64_t time) {
  const bool at_end =
      device.state.home == device.wiring.min || device.state.home == device.wiring.max;
  const std::uint64_t legs = at_end ? kLegsOfGesture - 1 : kLegsOfGesture;
  const std::uint64_t way = static_cast<std::uint64_t>(way_of_gesture(device)) * vm::kScale;
  const std::uint64_t least = 4 * legs * trapezoid::rounded_up(way, device.state.acceleration);
  if (time * time < least) return vm::kValueMax;
  const std::uint64_t ramps = (time - trapezoid::root(time * time - least)) / 2;
  return static_cast<std::int64_t>(way / (time - ramps));
}

// With OVER the whole gesture takes that long; its way is twice the range.
vm::Value gesture_speed(const Device& device, const Order& order, vm::Value speed) {
  const auto over = static_cast<std::int64_t>(duration_of(order.get(vm::Param::over, 0)));
  if (over == 0) return speed;
  const std::int64_t needed =
      has_ramps(device) ? speed_with_ramps(device, static_cast<std::uint64_t>(over / 1000))
                        : way_of_gesture(device) * 1'000'000 / over;
  return static_cast<vm::Value>(std::clamp<std::int64_t>(needed, 1, device.wiring.speed_limit));
}

[[gnu::noinline]] bool start_gesture(const Device& device, const Order& order, vm::Value speed,
                                     kernel::Time now) {
  if (speed <= 0 || device.wiring.min == device.wiring.max) return brake(device, now);
  const vm::Value times = order.get(vm::Param::times, vm::kScale) / vm::kScale;
  const vm::Value bounded = std::clamp(times, vm::Value{1}, kMostGestures);
  const bool brakes = has_ramps(device) && brake(device, now);
  device.state.home = position(device, now);
  device.state.speed = gesture_speed(device, order, speed);
  device.state.legs = static_cast<std::uint16_t>(bounded * kLegsOfGesture);
  return brakes || next_leg(device, now);
}

}  // namespace

vm::Value position_on_ramps(const ActuatorState& state, kernel::Time now) {
  const Motion& motion = state.motion;
  if (now >= motion.end()) return motion.to;
  const std::int64_t way =
      trapezoid::covered(distance(motion.from, motion.to), profile_of(state), passed(state, now));
  return static_cast<vm::Value>(motion.from + (motion.to > motion.from ? way : -way));
}

void stand(const Device& device, vm::Value position, kernel::Time now) {
  device.state.motion = {.from = position, .to = position, .begin = now, .length = 0};
  device.state.ramp = 0;
  device.state.speed = 0;
  device.state.legs = 0;
  device.state.placed = true;
}

void stand_at_rest(const Device& device, kernel::Time now) {
  stand(device, policy::rest_position(device.wiring), now);
}

void stop(const Device& device, vm::Release how, kernel::Time now) {
  if (how == vm::Release::rest) return stand_at_rest(device, now);
  if (!device.state.placed) return;
  const bool keeps_speed = has_ramps(device) && how == vm::Release::hold;
  const auto speed = static_cast<vm::Value>(keeps_speed ? velocity(device.state, now) : 0);
  stand(device, position(device, now), now);
  device.state.speed = speed;
}

[[gnu::noinline]] bool brake(const Device& device, kernel::Time now) {
  if (!has_ramps(device)) return false;
  const std::int64_t present = velocity(device.state, now);
  if (present == 0) return false;
  slow_down(device, position(device, now), present, now);
  device.state.legs = 0;
  return true;
}

bool has_target(const Order& order) {
  return order.has(vm::Param::to) || order.has(vm::Param::by);
}

vm::Value target_of(const Device& device, const Order& order, kernel::Time now) {
  if (order.has(vm::Param::to)) return order.get(vm::Param::to, 0);
  const bool back = order.get(vm::Param::direction, 1) < 0;
  const std::int64_t by = order.get(vm::Param::by, 0);
  const std::int64_t target = position(device, now) + (back ? -by : by);
  return static_cast<vm::Value>(
      std::clamp<std::int64_t>(target, device.wiring.min, device.wiring.max));
}

bool start(const Device& device, const Order& order, vm::Value usual, kernel::Time now) {
  if (!device.state.placed) stand_at_rest(device, now);
  const vm::Value speed = order.get(vm::Param::at, std::min(usual, device.wiring.speed_limit));
  if (!has_target(order)) return start_gesture(device, order, speed, now);
  return has_ramps(device) ? start_with_ramps(device, order, speed, now)
                           : start_move(device, order, speed, now);
}

bool next_leg(const Device& device, kernel::Time now) {
  const vm::Value here = position(device, now);
  // A gesture that begins at an end of the range is already there.
  if (device.state.legs != 0 && leg_target(device) == here) --device.state.legs;
  if (device.state.legs == 0) return false;
  const vm::Value target = leg_target(device);
  --device.state.legs;
  if (has_ramps(device))
    begin_ramps(device, target, device.state.speed, now);
  else
    begin_leg(device, here, target, travel_time(here, target, device.state.speed), now);
  return true;
}

}  // namespace robosync::drivers::way
