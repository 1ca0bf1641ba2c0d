// A panel of WS2812 lights. While a program has one, its pin belongs to SPI1 (wiring::kPanel).
#pragma once

#include "runtime-m4/boards/panel_output.hpp"

namespace robosync::boards::stm32l4 {

PanelOutput& panel_output();

}  // namespace robosync::boards::stm32l4
