// The drivers of this firmware, found by their number in the image: static dispatch over
// vm/drivers.def, one .cpp file for each. No driver blocks, allocates, or keeps state of its own, but for the microphone, whose
// state the sampler keeps (microphone.hpp).
#pragma once

#include <array>
#include <cstdint>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/features.hpp"
#include "runtime-m4/drivers/motion.hpp"
#include "runtime-m4/drivers/order.hpp"
#include "runtime-m4/guard/output_guard.hpp"
#include "runtime-m4/kernel/time.hpp"
#include "vm/image.hpp"

namespace robosync::drivers {

// --- sensors ---

// One sample of one channel as a raw count. False if the device did not answer.
using ReadFunction = bool (*)(boards::Board& board, const vm::Sensor& sensor,
                              const vm::Channel& channel, std::int32_t& raw);

// --- actuators ---

// What a driver stores about its actuator between calls.
struct ActuatorState {
  Motion motion;           // its position, as far as the driver knows
  vm::Value home = 0;      // where a gesture begins and ends, or where it goes after it has turned
  vm::Value speed = 0;     // of the legs to come, per second; way.cpp: other uses
  kernel::Time until = 0;  // when the command is done
  std::uint16_t legs = 0;  // movements of the gesture still to come
  bool placed = false;     // `motion` says where it is
  std::uint8_t actuator = 0;
  std::uint16_t acceleration = 0;  // its limit, in whole units per second squared; 0: none
  std::uint16_t ramp = 0;          // of `motion`, in milliseconds (trapezoid.hpp); 0: at one speed
};

struct Device {
  guard::OutputGuard& outputs;
  const vm::Actuator& wiring;
  ActuatorState& state;

  void drive(std::uint32_t pulse_us, kernel::Time now) const {
    outputs.drive(state.actuator, pulse_us, now);
  }
  // Of a servo.
  vm::ServoPulses pulses() const { return outputs.pulses_of(state.actuator); }
  void begin_order() const { outputs.begin_order(state.actuator); }
  // For a driver with two pins: drives the second one if the pulse is negative.
  void drive_either(std::int32_t pulse_us, kernel::Time now) const {
    outputs.drive_either(state.actuator, pulse_us, now);
  }
  void drive_wheels(std::int32_t left_us, std::int32_t right_us, kernel::Time now) const {
    outputs.drive_wheels(state.actuator, left_us, right_us, now);
  }
  void show(std::uint32_t picture) const { outputs.show(state.actuator, picture); }
  void sound(std::uint32_t hertz) const { outputs.sound(state.actuator, hertz); }
  void play(std::uint16_t sound) const { outputs.play(state.actuator, sound); }
};

inline constexpr kernel::Time kDone = 0;
// No time: those are multiples of kernel::kTick.
inline constexpr kernel::Time kBlocked = 1;

// start begins an order; advance continues it. Both return when they want to be called again,
// or kDone; advance also returns kBlocked, when what it did cannot go on and has been ended. release sets what the actuator does
// once nothing commands it, from any state.
using StartFunction = kernel::Time (*)(const Device& device, const Order& order, kernel::Time now);
using AdvanceFunction = kernel::Time (*)(const Device& device, kernel::Time now);
using ReleaseFunction = void (*)(const Device& device, vm::Release how, kernel::Time now);

#define SENSOR_DRIVER(name, ...)                                                        \
  namespace name {                                                                      \
  bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& channel, \
            std::int32_t& raw);                                                         \
  }
#define ACTUATOR_DRIVER(name, ...)                                                \
  namespace name {                                                                \
  kernel::Time start(const Device& device, const Order& order, kernel::Time now); \
  kernel::Time advance(const Device& device, kernel::Time now);                   \
  void release(const Device& device, vm::Release how, kernel::Time now);          \
  }
#include "vm/drivers.def"
#undef SENSOR_DRIVER
#undef ACTUATOR_DRIVER

struct Driver {
  ReadFunction read = nullptr;    // sensors
  StartFunction start = nullptr;  // actuators
  AdvanceFunction advance = nullptr;
  ReleaseFunction release = nullptr;
};

// Code for lights, speakers and microphones is left out if the board has none; code for displays, players, panels and parts on
// SPI if they cannot be connected.
constexpr bool is_present(vm::DriverId id) {
  if (vm::is_microphone(id)) return boards::kHasMicrophone;
  if (vm::is_board_part(id)) return boards::kHasParts;
  if (vm::drives_lights(id)) return boards::kHasLights;
  if (vm::drives_screen(id)) return boards::kHasI2c;
  if (vm::is_on_spi(id)) return boards::kHasSpi;
  if (vm::drives_player(id)) return boards::kHasSerialLine;
  if (vm::drives_panel(id)) return boards::kHasPanel;
  return boards::kHasSpeaker || !vm::drives_speaker(id);
}
template <vm::DriverId id>
constexpr Driver driver_if_present(Driver driver) {
  return is_present(id) ? driver : Driver{};
}

inline constexpr Driver kDrivers[] = {
#define SENSOR_DRIVER(name, ...) \
  driver_if_present<vm::DriverId::name>({name::read, nullptr, nullptr, nullptr}),
#define ACTUATOR_DRIVER(name, ...) \
  driver_if_present<vm::DriverId::name>({nullptr, name::start, name::advance, name::release}),
#include "vm/drivers.def"
#undef SENSOR_DRIVER
#undef ACTUATOR_DRIVER
};

// Bit d: driver d is in this firmware (vm::Limits::drivers).
inline constexpr std::uint64_t kPresent = [] {
  std::uint64_t present = 0;
  for (unsigned d = 0; d < sizeof kDrivers / sizeof kDrivers[0]; ++d)
    if (is_present(static_cast<vm::DriverId>(d))) present |= std::uint64_t{1} << d;
  return present;
}();

// `id` comes from a verified image.
constexpr const Driver& driver(vm::DriverId id) {
  return kDrivers[static_cast<std::size_t>(id)];
}

// Converts thousandths of a second, as in OVER and FOR, to microseconds; a negative value gives 0.
constexpr kernel::Duration duration_of(vm::Value thousandths) {
  return thousandths > 0 ? static_cast<kernel::Duration>(thousandths) * 1000 : 0;
}

}  // namespace robosync::drivers
