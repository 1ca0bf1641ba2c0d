// A board whose buses have DMA, so that they are asked ahead: I2C buses (asked_bus.hpp), and an SPI bus for parts (asked_spi.hpp).
//
// Buses says which:
//   i2c()   the I2C buses, as an array
//   Spi     the type of the SPI bus
//
// This code is on the way of each sample, so a file that is compiled for speed instantiates it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/board.hpp"

namespace robosync::boards {

extern const std::uint32_t kBusAheadMs;  // of the board's costs

template <typename Buses>
class AskingBoard : public Board {
public:
  bool i2c_transfer(std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
                    std::span<std::byte> in) final;
  bool i2c_read_two(std::uint8_t bus, std::uint8_t address, TwoBlocks blocks,
                    std::span<std::byte> in) final;
  bool i2c_select(std::uint8_t bus, std::uint8_t address, std::span<const std::byte> page) final;
  bool spi_transfer(std::uint8_t bus, std::uint16_t select, std::span<const std::byte> out,
                    std::span<std::byte> in) final;
  void spi_open(std::uint8_t bus, std::uint16_t select) final;
  void spi_close() final;
  BusState buses() const final;
  unsigned buses_ask_ahead() const final { return kBusAheadMs; }
  void ask_buses(bool ahead) final { asks_ahead_ = ahead; }
  bool buses_busy() const final;

  auto& i2c(unsigned bus) { return i2c_[bus]; }
  typename Buses::Spi& spi() { return spi_; }

protected:
  ~AskingBoard() = default;
  void start_i2c();

private:
  bool asks_ahead_ = false;
  decltype(Buses::i2c()) i2c_ = Buses::i2c();
  typename Buses::Spi spi_;
};

template <typename Buses>
void AskingBoard<Buses>::start_i2c() {
  for (auto& bus : i2c_)
    bus.start();
}

template <typename Buses>
bool AskingBoard<Buses>::i2c_transfer(std::uint8_t bus, std::uint8_t address,
                                      std::span<const std::byte> out, std::span<std::byte> in) {
  return bus < i2c_.size() && i2c_[bus].transfer(asks_ahead_, address, out, in);
}

template <typename Buses>
bool AskingBoard<Buses>::i2c_read_two(std::uint8_t bus, std::uint8_t address, TwoBlocks blocks,
                                      std::span<std::byte> in) {
  return bus < i2c_.size() && i2c_[bus].read_two(asks_ahead_, address, blocks, in);
}

// The address comes with the transfer.
template <typename Buses>
bool AskingBoard<Buses>::i2c_select(std::uint8_t bus, std::uint8_t /*address*/,
                                    std::span<const std::byte> page) {
  return bus < i2c_.size() && i2c_[bus].select(page);
}

template <typename Buses>
bool AskingBoard<Buses>::spi_transfer(std::uint8_t bus, std::uint16_t select,
                                      std::span<const std::byte> out, std::span<std::byte> in) {
  return bus == 0 && spi_.transfer(asks_ahead_, select, out, in);
}

template <typename Buses>
void AskingBoard<Buses>::spi_open(std::uint8_t /*bus*/, std::uint16_t select) {
  spi_.open(select);
}

template <typename Buses>
void AskingBoard<Buses>::spi_close() {
  spi_.close();
}

template <typename Buses>
bool AskingBoard<Buses>::buses_busy() const {
  return std::ranges::any_of(i2c_, [](const auto& bus) { return bus.is_busy(); }) || spi_.is_busy();
}

template <typename Buses>
BusState AskingBoard<Buses>::buses() const {
  BusState all;
  for (std::size_t bus = 0; bus < i2c_.size(); ++bus) {
    const BusState one = i2c_[bus].state();
    all.clears = static_cast<std::uint16_t>(all.clears + one.clears);
    all.held = static_cast<std::uint8_t>(all.held | one.held << bus);
  }
  return all;
}

}  // namespace robosync::boards
