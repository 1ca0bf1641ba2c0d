// How long an input is high after a pulse on an output: by interrupts at the two edges, of which no measurement has more.
#pragma once

#include <cstdint>

namespace robosync::boards::stm32l4::echoes {

// Ports and timers have their clock.
void start();
void ping(std::uint16_t trigger, std::uint16_t echo);
// In microseconds; 0: it was not measured. It is over then.
std::uint32_t take(std::uint16_t echo);
// `now` counts up at the clock of the core.  [interrupt of an edge]
void on_edge(std::uint32_t now);

}  // namespace robosync::boards::stm32l4::echoes
