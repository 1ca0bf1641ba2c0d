// Measures how long an input is high after a pulse on an output. Hardware takes the times and ends the pulse; an interrupt at
// each edge, at most two per measurement, reads the result.
#pragma once

#include <cstdint>

namespace robosync::boards::microbit::echoes {

void start();
void ping(std::uint16_t trigger, std::uint16_t echo);
// Ends the measurement. In microseconds; 0: not measured.
std::uint32_t take(std::uint16_t echo);
void on_edge();  // [interrupt of GPIOTE]

}  // namespace robosync::boards::microbit::echoes
