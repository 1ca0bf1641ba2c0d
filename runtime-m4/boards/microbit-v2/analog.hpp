// The voltages of the rings 0, 1 and 2, by the chip's converter, SAADC.
//
// They are outputs, too (pins.hpp): a ring that is measured must have been let go.
#pragma once

#include <cstdint>

namespace robosync::boards::microbit::analog {

// The crystal runs.
void start();
// Of 4095 (boards::kAnalogFull), which is the supply. False when the converter does not answer within some 40 us, or of another
// pin. [one thread at a time]
[[nodiscard]] bool read(std::uint16_t pin, std::uint16_t& voltage);

}  // namespace robosync::boards::microbit::analog
