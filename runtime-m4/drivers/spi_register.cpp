// Any SPI part with registers of 8 or 16 bits: writes the register's number (the channel's input), as the part wants it for
// reading, and reads the bytes after it. vm::SpiFormat says what they are.
#include <utility>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/drivers/spi_registers.hpp"

namespace robosync::drivers::spi_register {

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& channel,
          std::int32_t& raw) {
  const auto format = static_cast<vm::SpiFormat>(sensor.first_input);
  const bool is_byte = format >= vm::SpiFormat::uint8;
  std::array<std::byte, 2> in{};
  if (!read_spi(board, sensor, channel.input, std::span(in).first(is_byte ? 1 : 2))) return false;
  if (format == vm::SpiFormat::uint16le || format == vm::SpiFormat::int16le)
    std::swap(in[0], in[1]);
  const auto word =
      std::to_integer<std::uint32_t>(in[0]) << 8 | std::to_integer<std::uint32_t>(in[1]);
  const bool is_signed = format == vm::SpiFormat::int16 || format == vm::SpiFormat::int16le ||
                         format == vm::SpiFormat::int8;
  const std::int32_t value =
      is_signed ? static_cast<std::int16_t>(word) : static_cast<std::int32_t>(word);
  raw = is_byte ? value >> 8 : value;
  return true;
}

}  // namespace robosync::drivers::spi_register
