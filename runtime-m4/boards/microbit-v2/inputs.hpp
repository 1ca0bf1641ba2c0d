// The pins that programs may read: those of the edge connector that the buttons A (5) and B (11) are on. A button of one's
// own may be there as well, between the pin and GND.
//
// They are inputs from start() on and never anything else, and pulled up: a pin that nothing is wired to reads high.
#pragma once

#include <cstdint>

namespace robosync::boards::microbit::inputs {

void start();
// A pin that is no input: false.
bool is_high(std::uint16_t pin);

}  // namespace robosync::boards::microbit::inputs
