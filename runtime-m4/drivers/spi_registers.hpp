// What SPI drivers share: a byte that says what to read, and the bytes that the part sends after it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/board.hpp"
#include "vm/image.hpp"

namespace robosync::drivers {

// Inlined, without a frame of its own: a sensor's thread has no stack to spare for one.
[[gnu::always_inline]] inline bool read_spi(boards::Board& board, const vm::Sensor& sensor,
                                            std::uint8_t command, std::span<std::byte> in) {
  const std::array out{std::byte{command}};
  return board.spi_transfer(sensor.bus, sensor.address, out, in);
}

}  // namespace robosync::drivers
