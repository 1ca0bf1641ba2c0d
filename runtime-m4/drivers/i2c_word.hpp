// What I2C drivers share: one 16-bit word, low byte first, from an 8-bit register or command.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime-m4/boards/board.hpp"
#include "vm/image.hpp"

namespace robosync::drivers {

inline bool read_word(boards::Board& board, const vm::Sensor& sensor, std::byte command,
                      std::int32_t& raw) {
  const std::array out{command};
  std::array<std::byte, 2> in{};
  const auto address = static_cast<std::uint8_t>(sensor.address);
  if (!board.i2c_transfer(sensor.bus, address, out, in)) return false;
  raw = std::to_integer<std::int32_t>(in[0]) | std::to_integer<std::int32_t>(in[1]) << 8;
  return true;
}

}  // namespace robosync::drivers
