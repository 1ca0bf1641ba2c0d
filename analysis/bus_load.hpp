// What the I2C buses of a board that works them by themselves carry at once, and whether there is time for it.
//
// Its sensors are asked a tick before a reading is due, and what is not there two ticks later is given up. All of them may be due
// together: they are at a program's start, and where their periods meet.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime-m4/policy/costs.hpp"
#include "vm/image.hpp"

namespace robosync::analysis {

struct BusLoad {
  struct Share {
    unsigned sensor;   // in the image
    std::uint32_t us;  // what it asks for keeps the bus busy
  };
  std::uint8_t bus = 0;
  std::uint32_t us = 0;  // of them all
  std::vector<Share> shares{};
};

// Of a verified image: the buses that have not the time for what is asked of them at once (policy::kBusWindowUs).
[[nodiscard]] std::vector<BusLoad> overloaded_buses(const vm::Image& image,
                                                    const policy::BoardCosts& board);

}  // namespace robosync::analysis
