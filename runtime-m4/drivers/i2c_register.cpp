// Any I2C device with 16-bit registers: writes the register's number (the channel's input), reads
// two bytes, low byte first. The count is unsigned.
#include <array>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/drivers/i2c_registers.hpp"

namespace robosync::drivers::i2c_register {

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& channel,
          std::int32_t& raw) {
  return read_word(board, sensor, std::byte{channel.input}, raw);
}

}  // namespace robosync::drivers::i2c_register
