// The pins that programs may read: 7, 8, 9 and 12 of the board's Arduino header, numbered as printed there, and the blue
// button, which is on no header and has the number 32 here.
//
// They are inputs from start() on and never anything else, and pulled up: a pin that nothing is wired to reads high.
#pragma once

#include <array>
#include <cstdint>

#include "runtime-m4/boards/b-l475e-iot01a/registers.hpp"

namespace robosync::boards::l475::inputs {

struct Input {
  std::uint16_t pin;  // of the header
  Port port;
  unsigned bit;  // no two have the same
};
inline constexpr std::array kInputs{Input{7, kPortA, 4}, Input{8, kPortB, 2}, Input{9, kPortA, 15},
                                    Input{12, kPortA, 6}, Input{32, kPortC, 13}};

// Their ports have their clock.
void start();
inline bool is_high(const Input& input) {
  return input.port.levels().has(1U << input.bit);
}
// A pin that is no input: false.
bool is_high(std::uint16_t pin);

}  // namespace robosync::boards::l475::inputs
