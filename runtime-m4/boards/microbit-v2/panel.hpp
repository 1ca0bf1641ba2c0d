// A panel of WS2812 lights on an output of the edge connector (pins.hpp), which SPIM2 has while there is one.
#pragma once

#include "runtime-m4/boards/panel_output.hpp"

namespace robosync::boards::microbit {

PanelOutput& panel_output();

}  // namespace robosync::boards::microbit
