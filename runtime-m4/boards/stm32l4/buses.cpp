// The board's I2C buses. Their code is on the way of each sample, so this file is compiled for speed.
#include "runtime-m4/boards/stm32l4/board.hpp"
#include "runtime-m4/boards/stm32l4/spi.hpp"

namespace robosync::boards::stm32l4 {

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
  return is_any_busy(i2c_) || parts::is_busy();
}

BusState Board::buses() const {
  return state_of(i2c_);
}

extern "C" {

void HeaderBus_Handler();
void OwnBus_Handler();

void HeaderBus_Handler() {
  board.i2c(0).on_interrupt();
}

// For the last bus. A board with one bus has no vector for this.
void OwnBus_Handler() {
  board.i2c(wiring::kBuses.size() - 1).on_interrupt();
}

}  // extern "C"

}  // namespace robosync::boards::stm32l4
