// Frees the lines of an I2C bus. A device that was interrupted in the middle of a byte holds the data line low; given clocks, it
// releases the line at the end of the byte.
//
// Master is that of asked_bus.hpp.
#pragma once

namespace robosync::boards {

template <typename Master>
void clock_out(Master& master) {
  constexpr unsigned kMostClocks = 9;  // a byte and its acknowledge bit
  for (unsigned i = 0; i < kMostClocks && !master.data_is_high(); ++i) {
    master.drive_clock(false);
    master.half_bit();
    master.drive_clock(true);
    master.half_bit();
    if (!master.clock_is_high()) return;
  }
}

// False: a line stays low.
template <typename Master>
[[gnu::cold]] bool clear_lines(Master& master) {
  master.take_clock();
  clock_out(master);
  master.give_clock_back();
  return master.are_high();
}

}  // namespace robosync::boards
