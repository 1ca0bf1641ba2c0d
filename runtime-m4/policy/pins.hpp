// What a board lets programs do with its pins, and the check of a program against that, which the board makes at
// activation. Pure. Images are verified.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "vm/drive.hpp"
#include "vm/drivers.hpp"
#include "vm/image.hpp"
#include "vm/verifier.hpp"

namespace robosync::policy {

// Pins that may be outputs, and the limits of each; 0 µs is off, and always allowed.
struct PinLimit {
  std::uint16_t first, last;        // pins, both included
  std::uint16_t shortest, longest;  // pulse, in microseconds of the 20 ms frame
  std::uint16_t rise;  // µs by which the pulse may change per millisecond; 0: no limit
};

// An output that is also an input, of either kind, is a pin below this.
inline constexpr std::uint16_t kMostShared = 32;

struct PinRange {
  std::uint16_t first, last;  // both included
};

// An address on an I2C bus.
struct I2cPlace {
  std::uint8_t bus, address;
};

// From stdlib/boards/NAME.json. A pin that is not in `outputs` is no output, and likewise for inputs. A pin that is both is an
// output, and low, unless the running program has a sensor there (guard/output_guard.hpp); then nothing drives it.
struct BoardPins {
  std::span<const PinLimit> outputs;
  std::span<const PinRange> inputs;
  std::span<const PinRange> echoes =
      {};  // those of them whose edges can be timed and counted, which are no outputs
  std::span<const PinRange> analog;
  // Pins for the active-low enable inputs of chips with their own outputs. They are high from start-up, and whenever those outputs
  // must be off. Their only other use is to select a part on SPI.
  std::span<const PinRange> enables;
  // Outputs that can send a panel of lights its picture.
  std::span<const PinRange> panels = {};
  std::uint8_t i2c_buses = 0;
  std::span<const I2cPlace> reserved = {};  // addresses of the board's own parts, such as the store
  std::uint8_t serial_lines = 0;            // for players; the first is vm::kFirstPlayerLine
  std::uint8_t spi_buses = 0;
  std::span<const PinRange> spi_pins = {};  // that these have while a program has a part there
  std::span<const PinRange> selects =
      {};  // for the select inputs of parts: some of enables and outputs
  std::uint16_t player_pin = UINT16_MAX;  // of the first serial line, if it is one of spi_pins
};

// Null if the pin is no output.
constexpr const PinLimit* limit_of(const BoardPins& board, std::uint16_t pin) {
  for (const PinLimit& limit : board.outputs)
    if (pin >= limit.first && pin <= limit.last) return &limit;
  return nullptr;
}

constexpr bool is_in(std::span<const PinRange> ranges, std::uint16_t pin) {
  for (const PinRange& range : ranges)
    if (pin >= range.first && pin <= range.last) return true;
  return false;
}

constexpr bool is_input(const BoardPins& board, std::uint16_t pin) {
  return is_in(board.inputs, pin);
}

constexpr bool is_analog(const BoardPins& board, std::uint16_t pin) {
  return is_in(board.analog, pin);
}

// A pin that is limited to servo pulses cannot make the short trigger pulse.
constexpr bool can_trigger(std::uint16_t pin, const BoardPins& board) {
  const PinLimit* const limit = limit_of(board, pin);
  return limit != nullptr && limit->shortest == 0;
}

constexpr bool is_enable(const BoardPins& board, std::uint16_t pin) {
  return is_in(board.enables, pin);
}

constexpr bool is_select(const BoardPins& board, std::uint16_t pin) {
  return is_in(board.selects, pin);
}

constexpr bool is_for_panel(const BoardPins& board, std::uint16_t pin) {
  return is_in(board.panels, pin);
}

constexpr bool is_line(const BoardPins& board, std::uint8_t line) {
  return line >= vm::kFirstPlayerLine && line - vm::kFirstPlayerLine < board.serial_lines;
}

constexpr bool is_reserved(const vm::Sensor& sensor, const BoardPins& board) {
  for (const I2cPlace& place : board.reserved)
    if (place.bus == sensor.bus && place.address == sensor.address) return true;
  return false;
}

constexpr vm::Refusal judge(const vm::Sensor& sensor, const BoardPins& board) {
  if (vm::is_servo_chip(sensor.driver) && !is_enable(board, sensor.first_input))
    return vm::Refusal::no_pin;
  switch (vm::bus_of(sensor.driver)) {
    case vm::Bus::i2c:
      if (sensor.bus >= board.i2c_buses) return vm::Refusal::no_bus;
      return is_reserved(sensor, board) ? vm::Refusal::reserved_address : vm::Refusal::none;
    case vm::Bus::pin:
      return is_input(board, sensor.address) ? vm::Refusal::none : vm::Refusal::no_input;
    case vm::Bus::echo:
      if (!can_trigger(sensor.bus, board)) return vm::Refusal::no_pin;
      return is_in(board.echoes, sensor.address) ? vm::Refusal::none : vm::Refusal::no_input;
    case vm::Bus::edges:
      return is_in(board.echoes, sensor.address) &&
                     (!vm::has_second_input(sensor) || is_input(board, sensor.bus))
                 ? vm::Refusal::none
                 : vm::Refusal::no_input;
    case vm::Bus::adc:
      return is_analog(board, sensor.address) ? vm::Refusal::none : vm::Refusal::no_input;
    case vm::Bus::spi:
      if (sensor.bus >= board.spi_buses) return vm::Refusal::no_bus;
      return is_select(board, sensor.address) ? vm::Refusal::none : vm::Refusal::no_pin;
    case vm::Bus::sound:  // without one, the board has no driver for it
    case vm::Bus::part:
    case vm::Bus::nothing:
      break;
  }
  return vm::Refusal::none;
}

// A pin that is limited to servo pulses cannot drive a power output: it could make neither low power nor full power.
constexpr bool can_drive(vm::DriverId driver, std::uint16_t pin, const BoardPins& board) {
  const PinLimit* const limit = limit_of(board, pin);
  return limit != nullptr && (limit->shortest == 0 || !vm::gives_power(driver));
}

constexpr bool can_drive(const vm::Actuator& actuator, const BoardPins& board) {
  return can_drive(actuator.driver, actuator.pin, board) &&
         (!vm::has_two_pins(actuator.driver) || can_drive(actuator.driver, actuator.bus, board));
}

// `parameters` are those of the drive in its image.
constexpr bool can_drive(const vm::Actuator& drive, const vm::DriveParameters& parameters,
                         const BoardPins& board) {
  for (const vm::Side side : vm::kSides)
    if (!can_drive(vm::motor_of(drive, parameters, side), board)) return false;
  return true;
}

inline bool uses_spi(const vm::Image& image) {
  for (const vm::Sensor& sensor : image.sensors)
    if (vm::is_on_spi(sensor.driver)) return true;
  return false;
}

// Is the pin an output of an actuator or a sensor, or read by one? A panel's is not counted.
[[gnu::noinline]] inline bool uses_pin(const vm::Image& image, std::uint16_t pin) {
  for (const vm::Sensor& sensor : image.sensors)
    if (((vm::is_by_echo(sensor.driver) || vm::has_second_input(sensor)) && sensor.bus == pin) ||
        ((vm::reads_pin(sensor.driver) || vm::is_on_spi(sensor.driver)) && sensor.address == pin))
      return true;
  return vm::any_wired(image, [&](const vm::Actuator& actuator) {
    return vm::drives_pin(actuator.driver) &&
           (actuator.pin == pin || (vm::has_two_pins(actuator.driver) && actuator.bus == pin));
  });
}

// A bus with a part has its pins for itself.
inline bool shares_spi_pin(const vm::Image& image, const BoardPins& board) {
  if (!uses_spi(image)) return false;
  for (const PinRange& bus : board.spi_pins)
    for (std::uint32_t pin = bus.first; pin <= bus.last; ++pin)
      if (uses_pin(image, static_cast<std::uint16_t>(pin))) return true;
  for (const vm::Actuator& actuator : image.actuators)
    if ((vm::drives_panel(actuator.driver) && is_in(board.spi_pins, actuator.pin)) ||
        (vm::drives_player(actuator.driver) && is_in(board.spi_pins, board.player_pin)))
      return true;
  return false;
}

inline vm::Verdict judge(const vm::Image& image, const BoardPins& board) {
  for (std::size_t s = 0; s < image.sensors.size(); ++s) {
    const vm::Refusal refusal = judge(image.sensors[s], board);
    if (refusal != vm::Refusal::none)
      return {refusal, vm::Section::sensors, static_cast<std::uint16_t>(s)};
  }
  for (std::size_t a = 0; a < image.actuators.size(); ++a) {
    const vm::Actuator& actuator = image.actuators[a];
    if (vm::drives_pin(actuator.driver) && !can_drive(actuator, board))
      return {vm::Refusal::no_pin, vm::Section::actuators, static_cast<std::uint16_t>(a)};
    if (vm::drives_wheels(actuator.driver) &&
        !can_drive(actuator, vm::drive_of(image.constants.data() + actuator.pin), board))
      return {vm::Refusal::no_pin, vm::Section::actuators, static_cast<std::uint16_t>(a)};
    if (vm::drives_player(actuator.driver) && !is_line(board, actuator.bus))
      return {vm::Refusal::no_bus, vm::Section::actuators, static_cast<std::uint16_t>(a)};
    if (vm::drives_panel(actuator.driver) && !is_for_panel(board, actuator.pin))
      return {vm::Refusal::no_pin, vm::Section::actuators, static_cast<std::uint16_t>(a)};
  }
  if (shares_spi_pin(image, board)) return {vm::Refusal::shared_pin, vm::Section::sensors, 0};
  return {};
}

}  // namespace robosync::policy
