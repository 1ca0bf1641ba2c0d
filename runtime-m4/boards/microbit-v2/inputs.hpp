// The pins that programs may read: the edge connector's pins of the buttons A (5) and B (11). You may connect your own
// button as well, between the pin and GND.
//
// From start() on they are inputs and never anything else. They are pulled up: an unconnected pin reads high.
#pragma once

#include <array>
#include <cstdint>

#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit::inputs {

struct Input {
  std::uint16_t pin;  // of the edge connector
  Pin chip;
};
inline constexpr std::array kInputs{Input{5, {0, 14}}, Input{11, {0, 23}}};

void start();
inline bool is_high(const Input& input) {
  return input.chip.levels().has(input.chip.mask());
}
// False if the pin is not an input.
bool is_high(std::uint16_t pin);

}  // namespace robosync::boards::microbit::inputs
