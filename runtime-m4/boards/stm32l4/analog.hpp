// Voltages of pins (wiring::kAnalogInputs), by the chip's first converter, ADC1.
//
// They are analog inputs from start() on and never anything else.
#pragma once

#include <cstdint>

namespace robosync::boards::stm32l4::analog {

// Their port has its clock. A converter that does not come up does not answer later, either.
void start();
// Of 4095 (boards::kAnalogFull), which is VREF+, 3.3 V. False when the converter does not answer within some 30 us, or of another
// pin. [one thread at a time]
[[nodiscard]] bool read(std::uint16_t pin, std::uint16_t& voltage);

}  // namespace robosync::boards::stm32l4::analog
