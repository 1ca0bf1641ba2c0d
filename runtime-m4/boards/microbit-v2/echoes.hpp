// Measures how long an input is high after a pulse on an output. Hardware takes the times and ends the pulse; an interrupt at
// each edge, at most two per measurement, reads the result. Or counts the edges of an input, with an interrupt at each: as many as
// the last take allowed.
#pragma once

#include <cstdint>

#include "runtime-m4/boards/board.hpp"

namespace robosync::boards::microbit::echoes {

void start();
void ping(std::uint16_t trigger, std::uint16_t echo);
// Ends the measurement. In microseconds; 0: not measured.
std::uint32_t take(std::uint16_t echo);
bool take_edges(unsigned number, std::uint16_t a, std::uint8_t b, unsigned most,
                Turned& turned);                     // as Board::take_edges()
policy::EncoderCount edges_so_far(unsigned number);  // as Board::edges_so_far()
void end_edges(unsigned number);
void on_edge();  // [interrupt of GPIOTE]

}  // namespace robosync::boards::microbit::echoes
