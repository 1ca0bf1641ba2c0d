// A panel of WS2812 lights on an output of the edge connector (pins.hpp), which SPIM2 has while there is one.
#pragma once

#include "runtime-m4/boards/board.hpp"

namespace robosync::boards::microbit::panel {

// boards::Board::begin_panel(), show_on_panel(), end_panel().
void begin(const policy::Panel& panel);
void show(std::uint32_t picture);
void end();

}  // namespace robosync::boards::microbit::panel
