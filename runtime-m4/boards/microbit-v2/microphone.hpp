// The microphone on the board, measured by the chip's converter, SAADC: it writes 8,000 samples a second to memory, with no work
// for the core. Meanwhile the rings cannot be measured (analog.hpp).
//
// RUN_MIC (P0.20) gives the microphone its power, and lights the light beside it; its output is at AIN3 (P0.05).
#pragma once

#include "runtime-m4/boards/board.hpp"

namespace robosync::boards::microbit::microphone {

// No power.
void start();
// Switches it on or off. One that is on begins anew. [one thread at a time, this and hear()]
void listen(bool on);
[[nodiscard]] bool is_on();
// See boards::Board::hear().
[[nodiscard]] bool hear(SoundBlock sound);

}  // namespace robosync::boards::microbit::microphone
