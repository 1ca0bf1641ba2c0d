// What the I2C and SPI buses of a board must carry together, if they work on their own, and whether there is time for it.
//
// Sensors on such a bus are asked before a reading is due (bus_ahead_ms), and an answer that is not there two ticks later is given up.
// All of them may be due together: at a program's start, and where their periods meet.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime-m4/policy/costs.hpp"
#include "vm/image.hpp"

namespace robosync::analysis {

struct BusLoad {
  struct Share {
    unsigned sensor;   // in the image
    std::uint32_t us;  // how long its requests keep the bus busy
  };
  std::uint8_t bus = 0;
  bool spi = false;             // else I2C
  std::uint32_t us = 0;         // of all its sensors
  std::uint32_t window_us = 0;  // … and how long it has
  std::vector<Share> shares{};
};

// How long after it was asked a sensor on such a bus samples at most, if nothing else delays it: when that is due, or at the first
// tick at which all that may be asked of its bus before is done. In microseconds.
[[nodiscard]] std::uint32_t answered_in_us(const vm::Image& image, const policy::BoardCosts& board,
                                           const vm::Sensor& sensor);

// For a verified image: the buses that lack the time for all that may be asked of them together (policy::bus_window_us()).
[[nodiscard]] std::vector<BusLoad> overloaded_buses(const vm::Image& image,
                                                    const policy::BoardCosts& board);

}  // namespace robosync::analysis
