// The pins that programs may read (wiring::kInputs).
//
// From start() on they are inputs and never anything else. They are pulled up: an unconnected pin reads high.
#pragma once

#include <cstdint>

#include "runtime-m4/boards/stm32l4/wiring.hpp"

namespace robosync::boards::stm32l4::inputs {

// Their ports must have their clocks.
void start();
inline bool is_high(const Input& input) {
  return input.port.levels().has(1U << input.bit);
}
// False if the pin is not an input.
bool is_high(std::uint16_t pin);

}  // namespace robosync::boards::stm32l4::inputs
