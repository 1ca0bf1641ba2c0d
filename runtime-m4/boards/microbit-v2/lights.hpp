// The 25 lights: five rows, which are on while their pin is high, and five columns, which are on while theirs is low. One row
// is on at a time, for 2 ms, so that each light is on a hundred times a second.
//
// While the picture is dark, the timer is stopped.
#pragma once

#include <cstdint>

namespace robosync::boards::microbit::lights {

// Makes their pins outputs, with all lights dark.
void start();
// Shows a picture: bit 5 * row + column, from the top left; 0 is dark, immediately. [any processor state]
void show(std::uint32_t picture);
// Switches to the next row. [interrupt of TIMER1]
void next_row();

}  // namespace robosync::boards::microbit::lights
