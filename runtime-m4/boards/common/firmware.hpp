// What the start-up and the main() that all boards with a Cortex-M4 share need of a board, besides
// boards::Board and the hooks of the port. boards/NAME/ defines it, and the vector tables
// (vectors.hpp); main() defines robosync_kernel.
#pragma once

#include <cstddef>

#include "runtime-m4/boards/board.hpp"

// The board of this firmware. When it is constructed it starts the kernel's clock.
extern robosync::boards::Board& robosync_board;

namespace robosync::boards {

// Bytes that its line must be able to receive while nobody reads them.
inline constexpr std::size_t kReceiveBuffer = 512;

// Legal in any state of the machine, fault handlers and NMI included.
void switch_outputs_off();

}  // namespace robosync::boards
