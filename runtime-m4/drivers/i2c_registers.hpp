// What I2C drivers share: 8-bit registers or commands, and reading the data that follows them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/board.hpp"
#include "vm/image.hpp"

namespace robosync::drivers {

// Inlined, without a frame of its own: a sensor's thread has no stack to spare for one.
[[gnu::always_inline]] inline bool read_registers(boards::Board& board, const vm::Sensor& sensor,
                                                  std::byte first, std::span<std::byte> in) {
  const std::array out{first};
  return board.i2c_transfer(sensor.bus, static_cast<std::uint8_t>(sensor.address), out, in);
}

// `out` begins with the first register. The next sample reads the registers again, and so shows whether this succeeded.
inline void write_registers(boards::Board& board, const vm::Sensor& sensor,
                            std::span<const std::byte> out) {
  static_cast<void>(
      board.i2c_transfer(sensor.bus, static_cast<std::uint8_t>(sensor.address), out, {}));
}

// A 16-bit word, low byte first.
inline bool read_word(boards::Board& board, const vm::Sensor& sensor, std::byte command,
                      std::int32_t& raw) {
  std::array<std::byte, 2> in{};
  if (!read_registers(board, sensor, command, in)) return false;
  raw = std::to_integer<std::int32_t>(in[0]) | std::to_integer<std::int32_t>(in[1]) << 8;
  return true;
}

}  // namespace robosync::drivers
