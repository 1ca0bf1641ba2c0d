// A panel of WS2812 lights on a pin that SPI1 has while there is one (wiring::kPanel).
#pragma once

#include "runtime-m4/boards/panel_output.hpp"

namespace robosync::boards::stm32l4 {

PanelOutput& panel_output();

}  // namespace robosync::boards::stm32l4
