// A panel of WS2812 lights on D11 of the Arduino header, which SPI1 has while there is one.
#pragma once

#include "runtime-m4/boards/board.hpp"

namespace robosync::boards::l475::panel {

// boards::Board::begin_panel(), show_on_panel(), end_panel().
void begin(const policy::Panel& panel);
void show(std::uint32_t picture);
void end();

}  // namespace robosync::boards::l475::panel
