// The 25 lights: five rows, which are on while their pin is high, of five columns, which are on while theirs is low. One row
// at a time is on, for 2 ms, so that each light is on a hundred times a second.
//
// While the picture is dark nothing runs.
#pragma once

#include <cstdint>

namespace robosync::boards::microbit::lights {

// Their pins are outputs from now on, and all dark.
void start();
// The picture from now on: bit 5 * row + column, from the top left; 0 is dark, at once. Any state of the machine.
void show(std::uint32_t picture);
// The next row is on. [interrupt of TIMER1]
void next_row();

}  // namespace robosync::boards::microbit::lights
