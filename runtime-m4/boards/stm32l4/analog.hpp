// Voltages of pins (wiring::kAnalogInputs), measured by the chip's first converter, ADC1.
//
// From start() on, these pins are analog inputs and never anything else.
#pragma once

#include <cstdint>

namespace robosync::boards::stm32l4::analog {

// The pins' ports must have their clocks. If the converter does not come up here, read() always fails.
void start();
// 4095 (boards::kAnalogFull) is VREF+, 3.3 V. False when the converter does not answer within some 30 us, or for any other
// pin. [one thread at a time]
[[nodiscard]] bool read(std::uint16_t pin, std::uint16_t& voltage);

}  // namespace robosync::boards::stm32l4::analog
