// Measures how long an input is high after a pulse on an output, with at most two edge interrupts per measurement. Or counts the
// edges of an input, with as many interrupts as the last take allowed.
#pragma once

#include <cstdint>

#include "runtime-m4/boards/board.hpp"

namespace robosync::boards::stm32l4::echoes {

// Ports and timers must have their clocks.
void start();
void ping(std::uint16_t trigger, std::uint16_t echo);
// Ends the measurement. In microseconds; 0: not measured.
std::uint32_t take(std::uint16_t echo);
// As Board::take_edges(), at this time of on_edge().
bool take_edges(unsigned number, std::uint16_t a, std::uint8_t b, unsigned most, std::uint32_t now,
                Turned& turned);
policy::EncoderCount edges_so_far(unsigned number);  // as Board::edges_so_far()
void end_edges(unsigned number);
// `now` counts up at the core's clock rate.  [interrupt of an edge]
void on_edge(std::uint32_t now);

}  // namespace robosync::boards::stm32l4::echoes
