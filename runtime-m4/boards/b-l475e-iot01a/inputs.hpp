// The pins that programs may read: 7, 8, 9 and 12 of the board's Arduino header, numbered as printed there, and the blue
// button, which is on no header and has the number 32 here.
//
// They are inputs from start() on and never anything else, and pulled up: a pin that nothing is wired to reads high.
#pragma once

#include <cstdint>

namespace robosync::boards::l475::inputs {

// Their ports have their clock.
void start();
// A pin that is no input: false.
bool is_high(std::uint16_t pin);

}  // namespace robosync::boards::l475::inputs
