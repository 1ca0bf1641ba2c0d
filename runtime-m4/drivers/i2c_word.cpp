// Any I2C device with 16-bit registers in two's complement, high byte first: writes the register's number (the
// channel's input), reads two bytes.
#include <array>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/drivers/i2c_registers.hpp"

namespace robosync::drivers::i2c_word {

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& channel,
          std::int32_t& raw) {
  std::array<std::byte, 2> in{};
  if (!read_registers(board, sensor, std::byte{channel.input}, in)) return false;
  const auto word =
      std::to_integer<std::uint32_t>(in[0]) << 8 | std::to_integer<std::uint32_t>(in[1]);
  raw = static_cast<std::int16_t>(word);
  return true;
}

}  // namespace robosync::drivers::i2c_word
