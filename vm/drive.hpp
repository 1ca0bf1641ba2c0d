// A drive of two motors in an image. Its `pin` is the index of its parameters in the constants.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "vm/drivers.hpp"
#include "vm/image.hpp"

namespace robosync::vm {

inline constexpr unsigned kMaxDrives = 1;  // of a program
inline constexpr Value kFullTrim = 100;    // percent
// In millimetres; the arc of no angle overflows (runtime-m4/drivers/differential_drive.cpp).
inline constexpr Value kMostTrack = 2000 * kScale;

enum class Side : std::uint8_t { left, right };
inline constexpr std::array kSides = {Side::left, Side::right};

struct DriveParameters {
  std::array<std::uint8_t, 4> pins;  // left forward, left backward, right forward, right backward
  std::array<std::uint8_t, 2> trim;  // percent of its power that each motor gets
  std::uint16_t reserved;
  Value speed;  // of the robot with full power, per second
  Value track;  // the distance between the wheels
  Value usual;  // speed of an order without AT
};
inline constexpr std::size_t kDriveValues = sizeof(DriveParameters) / sizeof(Value);
using DriveValues = std::array<Value, kDriveValues>;

// `values`: those of the image, from the drive's index on.
constexpr DriveParameters drive_of(const Value* values) {
  DriveValues copy{};
  std::copy_n(values, copy.size(), copy.begin());
  return std::bit_cast<DriveParameters>(copy);
}

constexpr DriveValues values_of(const DriveParameters& parameters) {
  return std::bit_cast<DriveValues>(parameters);
}

// A motor of the drive, as if it were an actuator of its own.
constexpr Actuator motor_of(const Actuator& drive, const DriveParameters& parameters, Side side) {
  const std::size_t first = 2 * static_cast<std::size_t>(side);
  Actuator motor = drive;
  motor.driver = DriverId::motor;
  motor.pin = parameters.pins[first];
  motor.bus = parameters.pins[first + 1];
  return motor;
}

// Is `test` true for one of the actuators of a verified image? It gets the two motors of a drive in place of the drive.
template <class Test>
constexpr bool any_wired(const Image& image, Test test) {
  for (const Actuator& actuator : image.actuators) {
    if (!drives_wheels(actuator.driver)) {
      if (test(actuator)) return true;
      continue;
    }
    const DriveParameters parameters = drive_of(image.constants.data() + actuator.pin);
    for (const Side side : kSides)
      if (test(motor_of(actuator, parameters, side))) return true;
  }
  return false;
}

}  // namespace robosync::vm
