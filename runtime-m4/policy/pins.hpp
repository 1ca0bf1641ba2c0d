// What a board lets programs do with its pins, and the check of a program against it: the board makes it at
// activation. Pure. Images are verified.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "vm/drivers.hpp"
#include "vm/image.hpp"
#include "vm/verifier.hpp"

namespace robosync::policy {

// Pins that may be outputs, and how far a program may go with each; 0 µs is off, and always allowed.
struct PinLimit {
  std::uint16_t first, last;        // pins, both included
  std::uint16_t shortest, longest;  // pulse, in microseconds of the 20 ms frame
  std::uint16_t rise;               // µs that the pulse may change in a millisecond; 0: any
};

// stdlib/boards/NAME.json. A pin that stands in none of `outputs` is no output.
struct BoardPins {
  std::span<const PinLimit> outputs;
  std::uint8_t i2c_buses = 0;
};

// Null: no output.
constexpr const PinLimit* limit_of(const BoardPins& board, std::uint16_t pin) {
  for (const PinLimit& limit : board.outputs)
    if (pin >= limit.first && pin <= limit.last) return &limit;
  return nullptr;
}

inline vm::Verdict judge(const vm::Image& image, const BoardPins& board) {
  for (std::size_t s = 0; s < image.sensors.size(); ++s)
    if (vm::is_on_i2c(image.sensors[s].driver) && image.sensors[s].bus >= board.i2c_buses)
      return {vm::Refusal::no_bus, vm::Section::sensors, static_cast<std::uint16_t>(s)};
  for (std::size_t a = 0; a < image.actuators.size(); ++a) {
    const vm::Actuator& actuator = image.actuators[a];
    if (vm::pin_use(actuator.driver) != vm::PinUse::nothing &&
        limit_of(board, actuator.pin) == nullptr)
      return {vm::Refusal::no_pin, vm::Section::actuators, static_cast<std::uint16_t>(a)};
  }
  return {};
}

}  // namespace robosync::policy
