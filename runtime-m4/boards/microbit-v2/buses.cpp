// The board's I2C buses. Their code is on the way of each sample, so this file is compiled for speed.
#include "runtime-m4/boards/microbit-v2/board.hpp"
#include "runtime-m4/boards/microbit-v2/spi.hpp"

namespace robosync::boards::microbit {

bool Board::i2c_transfer(std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
                         std::span<std::byte> in) {
  return bus < i2c_.size() && i2c_[bus].transfer(asks_ahead_, address, out, in);
}

bool Board::i2c_read_two(std::uint8_t bus, std::uint8_t address, TwoBlocks blocks,
                         std::span<std::byte> in) {
  return bus < i2c_.size() && i2c_[bus].read_two(asks_ahead_, address, blocks, in);
}

// The address comes with the transfer.
bool Board::i2c_select(std::uint8_t bus, std::uint8_t /*address*/,
                       std::span<const std::byte> page) {
  return bus < i2c_.size() && i2c_[bus].select(page);
}

bool Board::buses_busy() const {
  return is_any_busy(i2c_) || spi::is_busy();
}

BusState Board::buses() const {
  return state_of(i2c_);
}

extern "C" {

void EdgeBus_Handler();
void OwnBus_Handler();

void EdgeBus_Handler() {
  board.i2c(0).on_interrupt();
}

void OwnBus_Handler() {
  board.i2c(1).on_interrupt();
}

}  // extern "C"

}  // namespace robosync::boards::microbit
