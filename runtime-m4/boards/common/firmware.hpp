// What the start-up code and main(), which all boards with a Cortex-M4 share, need from a board besides
// boards::Board and the port's hooks. boards/NAME/ defines it, and the vector tables
// (vectors.hpp); main() defines robosync_kernel.
#pragma once

#include <cstddef>

#include "runtime-m4/boards/board.hpp"

// The board of this firmware. Its constructor starts the kernel's clock.
extern robosync::boards::Board& robosync_board;

namespace robosync::boards {

// Bytes that its line must be able to receive before anybody reads them.
inline constexpr std::size_t kReceiveBuffer = 512;

// Legal in any processor state, including fault handlers and NMI.
void switch_outputs_off();

}  // namespace robosync::boards
