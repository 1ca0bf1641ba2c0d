// The pins that programs may read: those of the edge connector that the buttons A (5) and B (11) are on. A button of one's
// own may be there as well, between the pin and GND.
//
// They are inputs from start() on and never anything else, and pulled up: a pin that nothing is wired to reads high.
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
// A pin that is no input: false.
bool is_high(std::uint16_t pin);

}  // namespace robosync::boards::microbit::inputs
