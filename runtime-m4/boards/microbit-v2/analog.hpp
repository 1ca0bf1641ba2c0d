// The voltages of rings 0, 1 and 2, measured by the chip's converter, SAADC.
//
// The rings are outputs, too (pins.hpp): let_go() must release a ring before it is measured.
#pragma once

#include <cstdint>

namespace robosync::boards::microbit::analog {

// The crystal must be running.
void start();
// For read(), after something else has used the converter.
void configure();
// 4095 (boards::kAnalogFull) is the supply voltage. False when the converter does not answer within some 40 us, for any
// other pin, or while the microphone is on. [one thread at a time]
[[nodiscard]] bool read(std::uint16_t pin, std::uint16_t& voltage);

}  // namespace robosync::boards::microbit::analog
