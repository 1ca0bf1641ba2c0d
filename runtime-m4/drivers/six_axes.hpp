// A chip with an accelerometer and a gyroscope, counts of 16 bits each, on I2C. Its inputs 0 to 3 are those of axes.hpp, 4 to 6 how fast
// it turns about X, Y and Z: above 0 counter-clockwise, as seen from the axis' tip.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "runtime-m4/drivers/axes.hpp"
#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers {

struct SixAxes {
  static constexpr std::size_t kSettings = 3, kMostOutputs = 14;

  std::array<std::byte, 1 + kSettings>
      setting;                         // a register, and what it and the next ones are to hold
  std::array<std::byte, 2> wake;       // a register, and what ends its sleep; 0: the setting does
  std::byte output;                    // the first register of what it measures …
  std::uint8_t outputs;                // … how many there are, kMostOutputs at most …
  std::uint8_t acceleration, turning;  // … and which of them are the first ones of these
  std::endian order;                   // of the two bytes of a count
};

// As a ReadFunction. What it is told to do is read with each sample: out of a loss of power it has forgotten that, and is told
// again, one thing with each sample, which is none then.
bool read_six_axes(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& channel,
                   const SixAxes& chip, std::int32_t& raw);

}  // namespace robosync::drivers
