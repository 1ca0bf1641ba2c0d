// Maxim MAX34451 on PMBus: 16 analog inputs. PAGE selects the input, READ_VOUT gives its count.
#include <array>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/drivers/i2c_registers.hpp"

namespace robosync::drivers::max34451 {
namespace {

constexpr std::byte kPage{0x00};
constexpr std::byte kReadVout{0x8B};
constexpr std::uint8_t kInputs = 16;

}  // namespace

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& channel,
          std::int32_t& raw) {
  if (channel.input >= kInputs) return false;
  const std::array page{kPage, std::byte{channel.input}};
  const auto address = static_cast<std::uint8_t>(sensor.address);
  return board.i2c_select(sensor.bus, address, page) && read_word(board, sensor, kReadVout, raw);
}

}  // namespace robosync::drivers::max34451
