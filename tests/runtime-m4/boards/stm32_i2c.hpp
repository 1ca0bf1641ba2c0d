// A model of an I2C master of an STM32L475 with its two channels of DMA1, its two pins of port B, and one device on them, from
// ST's reference manual (RM0351). It is independent of the driver: addresses, fields and values are defined here again.
//
// Everything else that they can do is left out; using it throws an exception.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "tests/runtime-m4/boards/registers.hpp"

namespace robosync::tests {

class Stm32I2c : public RegisterModel {
public:
  struct Wiring {
    std::uintptr_t base;
    std::uint32_t clock_enable;           // a bit of RCC_APB1ENR1
    unsigned clock_pin, data_pin;         // of port B
    unsigned send_channel, read_channel;  // of DMA1, request 3
  };
  explicit Stm32I2c(const Wiring& wiring) : wiring_(wiring) {}

  // --- the device ---
  unsigned address = 0x6A;
  // The first byte written selects one, bit 7 is ignored.
  std::vector<std::byte> registers = std::vector<std::byte>(256);
  unsigned refuses_after = ~0U;  // bytes of a message that are acknowledged
  bool holds_clock = false;
  unsigned holds_data = 0;                      // clocks until it releases the data line
  unsigned clocks = 0;                          // clocks outside of transfers
  std::vector<std::vector<std::byte>> written;  // messages, in order

  // --- other events ---
  bool another_master = false;      // takes the bus at the next byte
  bool dma_fails = false;           // at the next byte; the channel is off then
  bool spurious_bus_error = false;  // at the next byte (ES0250: meaningless for a master)

  void pass_microsecond();
  bool interrupt() const;
  bool is_on() const { return (control_ & 1) != 0; }

  std::uint32_t read(std::uintptr_t address) override;
  void write(std::uintptr_t address, std::uint32_t value) override;

private:
  enum class Phase { idle, sending, reading, ended, stopping };
  struct Channel {
    std::uint32_t control = 0, count = 0, peripheral = 0, memory = 0, moved = 0;
    bool failed = false;
  };

  bool pulls_low(unsigned pin) const;
  bool is_mode_of_master(unsigned pin) const;
  std::uint32_t levels() const;
  void watch_clock();
  std::uint32_t pin_register(std::uintptr_t offset) const;
  void write_pin(std::uintptr_t offset, std::uint32_t value);
  void write_channel(std::uintptr_t offset, std::uint32_t value);
  void write_own(std::uintptr_t offset, std::uint32_t value);
  void write_control(std::uint32_t value);
  void write_timing(std::uint32_t value);
  void write_transfer(std::uint32_t value);
  void reset();
  void start();
  void next_byte();
  void send_byte();
  void read_byte();
  void refuse();
  void stop();
  void end_of_bytes();
  volatile std::byte* dma(unsigned number, bool from_memory, std::uint32_t data_register);
  void fetch();

  static constexpr unsigned kByte = 24;  // microseconds for nine bits

  Wiring wiring_;
  std::map<std::uintptr_t, std::uint32_t> pins_{{0x00, 0xFFFF'FEBF}, {0x04, 0}, {0x0C, 0x100},
                                                {0x14, 0},           {0x24, 0}, {0x20, 0}};
  std::map<unsigned, Channel> channels_;
  std::uint32_t select_ = 0, dma_clock_ = 0, clock_ = 0;
  std::uint32_t control_ = 0, transfer_ = 0, timing_ = 0, state_ = 1;
  bool was_high_ = true, reset_seen_ = true, data_waits_ = false;
  std::byte data_{};
  Phase phase_ = Phase::idle;
  unsigned left_ = 0, done_ = 0, place_ = 0;
};

}  // namespace robosync::tests
