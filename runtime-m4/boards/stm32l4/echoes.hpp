// Measures how long an input is high after a pulse on an output, with at most two edge interrupts per measurement.
#pragma once

#include <cstdint>

namespace robosync::boards::stm32l4::echoes {

// Ports and timers must have their clocks.
void start();
void ping(std::uint16_t trigger, std::uint16_t echo);
// Ends the measurement. In microseconds; 0: not measured.
std::uint32_t take(std::uint16_t echo);
// `now` counts up at the core's clock rate.  [interrupt of an edge]
void on_edge(std::uint32_t now);

}  // namespace robosync::boards::stm32l4::echoes
