// What the I2C and SPI buses of a board must carry together, if they work on their own, and whether there is time for it.
//
// Sensors on such a bus are asked a tick before a reading is due, and an answer that is not there two ticks later is given up.
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
  bool spi = false;      // else I2C
  std::uint32_t us = 0;  // of all its sensors
  std::vector<Share> shares{};
};

// For a verified image: the buses that lack the time for all that may be asked of them together (policy::kBusWindowUs).
[[nodiscard]] std::vector<BusLoad> overloaded_buses(const vm::Image& image,
                                                    const policy::BoardCosts& board);

}  // namespace robosync::analysis
