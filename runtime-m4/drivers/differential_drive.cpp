// Two motors that drive a robot. Its speed is proportional to the power, up to its speed with full power. By timing, nothing measures
// how far it went: a wheel's way and speed give the time, and then both motors go off. With encoders each wheel goes on until it has
// counted its way (policy/travel.hpp), and only what is ordered for a time ends by timing.
//
//   TO, BY          straight, at AT or the usual speed, or in OVER. Its position is the way since the program began, without turns
//   BY of a play    turns by that angle: each wheel goes along an arc around the middle between them
//   TIMES           turns round that often, or goes straight for that many seconds
//   otherwise       for as long as FOR or OVER says, or for a second
//
// OVER is stretched if it would need more than the greatest speed. A turn to the right is positive.
#include <algorithm>

#include "runtime-m4/drivers/timed.hpp"
#include "runtime-m4/drivers/way.hpp"
#include "vm/drive.hpp"

namespace robosync::drivers::differential_drive {
namespace {

constexpr kernel::Duration kFrameUs = 20'000;
constexpr kernel::Duration kMicroseconds = 1'000'000;
// 355 / 113 is pi, but for a ten-millionth.
constexpr std::int64_t kPiAbove = 355, kPiBelow = 113;
constexpr std::int64_t kWholeTurn = 360 * std::int64_t{vm::kScale};

// What the wheels do: both backward if `back`, or for a turn the left one.
struct Course {
  vm::Value way = 0;  // as long as that of each wheel; negative if `back`
  kernel::Duration length = 0;
  vm::Value speed = 0;
  bool back = false;
  bool for_a_time = false;  // it ends by timing
};

constexpr std::int64_t kFarthest = INT32_MAX;

vm::Value bounded(std::int64_t amount) {
  return static_cast<vm::Value>(std::clamp(amount, -kFarthest, kFarthest));
}

vm::Value most_of(const Device& device, const vm::DriveParameters& drive) {
  return std::min(device.wiring.speed_limit, drive.speed);
}

// A way of the wheels at their speed, or in OVER.
Course along(std::int64_t way, const Order& order, vm::Value speed, vm::Value most) {
  Course course{.way = bounded(way), .speed = speed, .back = way < 0};
  if (!order.has(vm::Param::over)) {
    course.length = travel_time(0, course.way, speed);
    return course;
  }
  const kernel::Duration over = duration_of(order.get(vm::Param::over, 0));
  course.length = std::max(over, travel_time(0, course.way, most));
  if (course.length == 0 || course.length == kernel::kForever) return course;
  const auto size =
      static_cast<kernel::Duration>(course.back ? -std::int64_t{course.way} : course.way);
  const kernel::Duration needed = size * kMicroseconds / course.length;
  course.speed = static_cast<vm::Value>(std::min(needed, static_cast<kernel::Duration>(most)));
  return course;
}

Course for_a_time(kernel::Duration length, bool back, vm::Value speed) {
  const std::int64_t way = static_cast<std::int64_t>(length / 1000) * speed / 1000;
  return {.way = bounded(back ? -way : way),
          .length = length,
          .speed = speed,
          .back = back,
          .for_a_time = true};
}

kernel::Duration time_of(const Order& order) {
  if (order.has(vm::Param::for_)) return duration_of(order.get(vm::Param::for_, 0));
  if (order.has(vm::Param::over)) return duration_of(order.get(vm::Param::over, 0));
  return duration_of(order.get(vm::Param::times, vm::kScale));
}

std::int64_t arc_of(std::int64_t angle, const vm::DriveParameters& drive) {
  return std::int64_t{bounded(angle)} * drive.track * kPiAbove / (kPiBelow * kWholeTurn);
}

// Not inline, like powers_of() and go(): the stack of an actuator's thread has no room for all of them at once.
[[gnu::noinline]] Course course_of(const Device& device, const Order& order,
                                   const vm::Value* parameters, vm::Value position) {
  const vm::DriveParameters drive = vm::drive_of(parameters);
  const vm::Value most = most_of(device, drive);
  const vm::Value speed = std::min(order.get(vm::Param::at, drive.usual), most);
  const bool back = order.get(vm::Param::direction, 1) < 0;
  const bool turns = order.action == vm::Action::play;
  std::int64_t amount = 0;
  if (order.has(vm::Param::by)) {
    amount = order.get(vm::Param::by, 0);
  } else if (turns && order.has(vm::Param::times)) {
    amount = order.get(vm::Param::times, 0) / vm::kScale * kWholeTurn;
  } else if (!turns && order.has(vm::Param::to)) {
    return along(std::int64_t{order.get(vm::Param::to, 0)} - position, order, speed, most);
  } else {
    return for_a_time(time_of(order), back, speed);
  }
  if (turns) amount = arc_of(amount, drive);
  return along(back ? -amount : amount, order, speed, most);
}

// Of a motor without trim.
std::uint32_t pulse_of(vm::Value speed, const vm::DriveParameters& drive) {
  return static_cast<std::uint32_t>(static_cast<kernel::Duration>(speed) * kFrameUs /
                                    static_cast<kernel::Duration>(drive.speed));
}

std::int32_t trimmed(std::uint32_t pulse, vm::Side side, const vm::DriveParameters& drive) {
  return static_cast<std::int32_t>(pulse * drive.trim[static_cast<std::size_t>(side)] /
                                   std::uint32_t{vm::kFullTrim});
}

struct Powers {
  std::int32_t left, right;
};

[[gnu::noinline]] Powers powers_of(const Course& course, bool turns, const vm::Value* parameters) {
  const vm::DriveParameters drive = vm::drive_of(parameters);
  const std::uint32_t pulse = pulse_of(course.speed, drive);
  const std::int32_t left = trimmed(pulse, vm::Side::left, drive);
  const std::int32_t right = trimmed(pulse, vm::Side::right, drive);
  return {course.back ? -left : left, course.back != turns ? -right : right};
}

// The position stays within the range, which the robot may leave.
vm::Value in_range(const Device& device, std::int64_t position) {
  return static_cast<vm::Value>(
      std::clamp<std::int64_t>(position, device.wiring.min, device.wiring.max));
}

// Where its wheels had come to when they were last looked at, or where it is by timing.
[[gnu::noinline]] void stand_here(const Device& device, kernel::Time now) {
  guard::CountedDrive* const counted = device.outputs.counted_drive();
  if (counted == nullptr || !counted->travel.is_on())
    return way::stop(device, vm::Release::hold, now);
  const std::int64_t way = counted->heading * counted->travel.way();
  counted->travel.end();
  way::stand(device, in_range(device, device.state.motion.from + way), now);
}

void stop(const Device& device, kernel::Time now) {
  stand_here(device, now);
  device.drive_wheels(0, 0, now);
}

[[gnu::noinline]] void go(const Device& device, const Course& course, bool turns,
                          kernel::Time now) {
  const vm::Value from = device.state.motion.at(now);
  const std::int64_t way = turns ? 0 : course.way;
  device.state.motion = {
      .from = from, .to = in_range(device, from + way), .begin = now, .length = course.length};
  device.state.until = now + course.length;
}

std::uint32_t in_ms(kernel::Time time) {
  return static_cast<std::uint32_t>(time / 1000);
}

// Gives each wheel its part of the power. Returns when to look again.
kernel::Time go_on(const Device& device, const guard::CountedDrive& counted, kernel::Time now) {
  const policy::Travel& travel = counted.travel;
  device.drive_wheels(counted.pulses[0] * travel.share(vm::Side::left) / 100,
                      counted.pulses[1] * travel.share(vm::Side::right) / 100, now);
  return std::min(now + kernel::milliseconds(travel.next_look_ms(in_ms(now))), device.state.until);
}

// After go(), for a drive with encoders, which have just been counted: each wheel goes until it has counted its way. Returns when to
// look. Not inline, and calls nothing that drives: the stack has no room for both.
[[gnu::noinline]] kernel::Time set_out(const Device& device, guard::CountedDrive& counted,
                                       const Course& course, Powers& powers, bool turns,
                                       kernel::Time now) {
  const std::int64_t size = course.back ? -std::int64_t{course.way} : course.way;
  const std::array back = {powers.left < 0 && counted.encoders[0].knows_direction,
                           powers.right < 0 && counted.encoders[1].knows_direction};
  counted.pulses = {static_cast<std::int16_t>(powers.left),
                    static_cast<std::int16_t>(powers.right)};
  counted.heading = static_cast<std::int8_t>(turns ? 0 : course.back ? -1 : 1);
  counted.travel.begin(counted.encoders, counted.counts, back,
                       course.for_a_time ? policy::Travel::kNoTarget : size, course.speed,
                       in_ms(now));
  if (counted.travel.has_arrived(vm::Side::left)) powers.left = 0;
  if (counted.travel.has_arrived(vm::Side::right)) powers.right = 0;
  if (!course.for_a_time) device.state.until = kernel::kForever;
  return std::min(now + kernel::milliseconds(counted.travel.next_look_ms(in_ms(now))),
                  device.state.until);
}

// A movement takes a frame at least, whatever its wheels do: response times are worked out with that (analysis/).
[[gnu::noinline]] kernel::Time look(const Device& device, guard::CountedDrive& counted,
                                    kernel::Time now) {
  using State = policy::Travel::State;
  device.outputs.count_wheels(now);
  const State state = counted.travel.look(counted.counts, in_ms(now));
  const bool is_early = state == State::arrived && now < device.state.motion.begin + way::kFrame;
  if ((state == State::going || is_early) && now < device.state.until)
    return go_on(device, counted, now);
  stop(device, now);
  return state == State::blocked ? kBlocked : kDone;
}

}  // namespace

kernel::Time start(const Device& device, const Order& order, kernel::Time now) {
  const vm::Value* const parameters = device.outputs.drive_parameters();
  if (parameters == nullptr) return kDone;
  if (!device.state.placed) way::stand(device, 0, now);
  stand_here(device, now);
  Course course;
  if (order.action != vm::Action::stop)
    course = course_of(device, order, parameters, device.state.motion.at(now));
  if (course.length == 0 || course.length == kernel::kForever || course.speed == 0) {
    stop(device, now);
    return kDone;
  }
  const bool turns = order.action == vm::Action::play;
  Powers powers = powers_of(course, turns, parameters);
  go(device, course, turns, now);
  kernel::Time wake = device.state.until;
  if (guard::CountedDrive* const counted = device.outputs.counted_drive()) {
    device.outputs.count_wheels(now);
    wake = set_out(device, *counted, course, powers, turns, now);
  }
  device.drive_wheels(powers.left, powers.right, now);
  return wake;
}

kernel::Time advance(const Device& device, kernel::Time now) {
  guard::CountedDrive* const counted = device.outputs.counted_drive();
  if (counted != nullptr && counted->travel.is_on()) return look(device, *counted, now);
  if (now < device.state.until) return device.state.until;
  stop(device, now);
  return kDone;
}

// Whatever `how`: nobody would end what it does.
void release(const Device& device, vm::Release, kernel::Time now) {
  stop(device, now);
}

}  // namespace robosync::drivers::differential_drive
