// The pins that programs may read (wiring::kInputs).
//
// They are inputs from start() on and never anything else, and pulled up: a pin that nothing is wired to reads high.
#pragma once

#include <cstdint>

#include "runtime-m4/boards/stm32l4/wiring.hpp"

namespace robosync::boards::stm32l4::inputs {

// Their ports have their clock.
void start();
inline bool is_high(const Input& input) {
  return input.port.levels().has(1U << input.bit);
}
// A pin that is no input: false.
bool is_high(std::uint16_t pin);

}  // namespace robosync::boards::stm32l4::inputs
