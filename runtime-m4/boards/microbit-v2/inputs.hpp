// The pins that programs may read: those of the buttons A (5) and B (11), where you may connect your own button as well, 8 and 9,
// and the pins for pulses (pins.hpp). All are pulled up: an unconnected pin reads high.
//
// The ones of this file are inputs from start() on, and never anything else. A pin for pulses is an input from pins::let_go() on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit::inputs {

struct Input {
  std::uint16_t pin;  // of the edge connector
  Pin chip;
};
inline constexpr std::array kInputs{Input{5, {0, 14}}, Input{11, {0, 23}}, Input{8, {0, 10}},
                                    Input{9, {0, 9}}};
inline constexpr std::size_t kEchoes = 3;  // the first ones, which can measure an echo (echoes.hpp)

// In a new chip, the pins 8 and 9 are those of the NFC antenna. Changes that for good. True: it takes effect with the next reset.
[[nodiscard]] bool free_from_nfc();
void start();
inline bool is_high(const Input& input) {
  return input.chip.levels().has(input.chip.mask());
}
// False if the pin is not an input.
bool is_high(std::uint16_t pin);

}  // namespace robosync::boards::microbit::inputs
