// How long an input is high after a pulse on an output. The chip measures it and ends the pulse by itself; an interrupt at each
// of the two edges, of which no measurement has more, takes what was measured.
#pragma once

#include <cstdint>

namespace robosync::boards::microbit::echoes {

void start();
void ping(std::uint16_t trigger, std::uint16_t echo);
// In microseconds; 0: it was not measured. It is over then.
std::uint32_t take(std::uint16_t echo);
void on_edge();  // [interrupt of GPIOTE]

}  // namespace robosync::boards::microbit::echoes
