// A panel of WS2812 lights on D11 of the Arduino header, which SPI1 has while there is one.
#pragma once

#include "runtime-m4/boards/panel_output.hpp"

namespace robosync::boards::l475 {

PanelOutput& panel_output();

}  // namespace robosync::boards::l475
