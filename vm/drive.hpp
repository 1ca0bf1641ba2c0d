// A drive of two motors in an image. Its `pin` is the index of its parameters in the constants.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>

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
  std::array<std::uint8_t, 2> encoders;  // the sensors of its wheels, plus 1; 0: it goes by timing
  Value speed;                           // of the robot with full power, per second
  Value track;                           // the distance between the wheels
  Value usual;                           // speed of an order without AT
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

constexpr bool has_encoders(const DriveParameters& parameters) {
  return parameters.encoders[0] != 0;
}

// A drive of a verified image that goes by its encoders.
constexpr bool is_counted_drive(const Image& image, std::size_t actuator) {
  const Actuator& one = image.actuators[actuator];
  return drives_wheels(one.driver) && has_encoders(drive_of(image.constants.data() + one.pin));
}

// The encoder of a wheel, of whose edges each is `above` / `below` of the wheel's way.
struct WheelEncoder {
  std::int32_t above;
  std::uint16_t below;
  std::uint8_t number;  // among the program's encoders
  bool knows_direction;
};
using WheelEncoders = std::array<WheelEncoder, 2>;

// Sensors and channels must have been checked. nullopt: it has no encoder there whose edges have a way.
constexpr std::optional<WheelEncoder> encoder_of(const Image& image, const DriveParameters& drive,
                                                 Side side) {
  const unsigned place = drive.encoders[static_cast<std::size_t>(side)];
  if (place == 0 || place > image.sensors.size()) return std::nullopt;
  const Sensor& sensor = image.sensors[place - 1];
  if (!counts_edges(sensor.driver)) return std::nullopt;
  for (const Channel& channel : image.channels.subspan(sensor.first_channel, sensor.channel_count))
    if (channel.input == kDistanceInput && channel.scale_num > 0)
      return WheelEncoder{.above = channel.scale_num,
                          .below = channel.scale_den,
                          .number = static_cast<std::uint8_t>(encoder_number(image, place - 1)),
                          .knows_direction = has_second_input(sensor)};
  return std::nullopt;
}

// Of a drive with encoders, where there are no wheels (runtime-m4/policy/virtual_wheels.hpp): by how many percent the right one is
// slower. Its `bus` has it.
inline constexpr std::int8_t kMostDifference = 20;
constexpr std::int8_t difference_of(const Actuator& drive) {
  return static_cast<std::int8_t>(drive.bus);
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
