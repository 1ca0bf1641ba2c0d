// A panel of WS2812 lights on an output of the edge connector (pins.hpp). While a program has one, the pin belongs to SPIM2.
#pragma once

#include "runtime-m4/boards/panel_output.hpp"

namespace robosync::boards::microbit {

PanelOutput& panel_output();

}  // namespace robosync::boards::microbit
