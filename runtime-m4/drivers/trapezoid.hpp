// A movement with a limit of acceleration: its speed rises evenly, stays, and falls evenly to 0, which is a trapezoid over
// time, or a triangle if the way is short. All of it in integers, in milliseconds. With the way D, the time R of a ramp and the
// time C until it slows down, which is length - R:
//
//   speed D / C, acceleration D / (R * C), and position at t:  D * t * t / (2 * R * C)     while it speeds up, t < R
//                                                              D * (2 * t - R) / (2 * C)   then
//
// The second half is the first half backwards: so it ends exactly at its target, with speed 0. R and C are rounded up, so that
// neither limit is exceeded; a position is rounded by less than a thousandth, towards the nearer end.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "vm/value.hpp"

namespace robosync::drivers::trapezoid {

// A ramp takes no longer, so that products fit into 64 bits. An actuator that would need more time to reach a speed
// moves slower than that.
inline constexpr std::uint64_t kLongestRamp = 65'535;
inline constexpr std::uint64_t kLongest = INT32_MAX;

struct Profile {
  std::uint64_t ramp = 0;    // R, 0 if there is no way; at most half of the length
  std::uint64_t length = 0;  // R + C
};

constexpr std::uint64_t rounded_up(std::uint64_t number, std::uint64_t divisor) {
  return (number + divisor - 1) / divisor;
}

// The largest whole number whose square is not above `number`.
constexpr std::uint32_t root(std::uint64_t number) {
  std::uint64_t left = number;
  std::uint64_t found = 0;
  for (int place = static_cast<int>(std::bit_width(number | 1) - 1) / 2 * 2; place >= 0;
       place -= 2) {
    const std::uint64_t more = found + (std::uint64_t{1} << place);
    found /= 2;
    if (left < more) continue;
    left -= more;
    found += std::uint64_t{1} << place;
  }
  return static_cast<std::uint32_t>(found);
}
constexpr std::uint64_t root_rounded_up(std::uint64_t number) {
  return number == 0 ? 0 : root(number - 1) + std::uint64_t{1};
}

// The least R * C. `way` is in thousandths, `acceleration` in whole units per second squared, above 0.
constexpr std::uint64_t least_product(std::uint32_t way, std::uint32_t acceleration) {
  return rounded_up(std::uint64_t{way} * vm::kScale, acceleration);
}

// The shortest time for a way at `speed`, in thousandths per second, above 0.
constexpr Profile shortest(std::uint32_t way, vm::Value speed, std::uint32_t acceleration) {
  if (way == 0) return {};
  const std::uint64_t fastest =
      std::min(static_cast<std::uint64_t>(speed), acceleration * kLongestRamp);
  const std::uint64_t ramp = rounded_up(fastest, acceleration);
  const std::uint64_t rest = rounded_up(std::uint64_t{way} * vm::kScale, fastest);
  if (rest >= ramp) return {ramp, std::min(ramp + rest, kLongest)};
  const std::uint64_t half = root_rounded_up(least_product(way, acceleration));
  return {half, 2 * half};
}

// The slowest way to take `length`, which is no less than the shortest time: the least R with R * (length - R) large enough.
constexpr Profile stretched(std::uint32_t way, std::uint64_t length, std::uint32_t acceleration) {
  const std::uint64_t product = least_product(way, acceleration);
  return {(length - root(length * length - 4 * product) + 1) / 2, length};
}

// How far it has come. `passed` is at most the length.
constexpr std::uint32_t covered(std::uint32_t way, const Profile& profile, std::uint64_t passed) {
  const bool late = 2 * passed > profile.length;
  const std::uint64_t time = late ? profile.length - passed : passed;
  const std::uint64_t rest = profile.length - profile.ramp;
  const std::uint64_t part = time < profile.ramp ? way * (time * time) / (2 * profile.ramp * rest)
                                                 : way * (2 * time - profile.ramp) / (2 * rest);
  return static_cast<std::uint32_t>(late ? way - part : part);
}

// Its speed then, in thousandths per second.
constexpr std::uint64_t speed_at(std::uint32_t way, const Profile& profile, std::uint64_t passed) {
  const std::uint64_t time = std::min({passed, profile.length - passed, profile.ramp});
  return std::uint64_t{way} * time * vm::kScale / (profile.ramp * (profile.length - profile.ramp));
}

// How long it takes to reach `speed`, and to stop at that speed.
constexpr std::uint64_t ramp_to(std::uint64_t speed, std::uint32_t acceleration) {
  return std::min(rounded_up(speed, acceleration), kLongestRamp);
}

}  // namespace robosync::drivers::trapezoid
