// A model of an I2C master of an nRF52833 (TWIM), from Nordic's Product Specification, with the two lines and one device
// on them. It is independent of the driver: addresses, fields and values are defined here again.
//
// Everything else that a master can do is left out; using it throws an exception.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "tests/runtime-m4/boards/nrf52833.hpp"

namespace robosync::tests {

class TwimBus : public Nrf52833 {
public:
  TwimBus(std::uintptr_t base, Pin clock, Pin data) : base_(base), clock_(clock), data_(data) {
    wire_lines();
  }

  // --- the device ---
  unsigned address = 0x19;
  std::vector<std::byte> registers =
      std::vector<std::byte>(256);  // the first byte written selects one, bit 7 is ignored
  unsigned refuses_after = ~0U;     // bytes of a message that are acknowledged
  unsigned stops_after =
      ~0U;  // bytes of a reading: then a stop is on the lines that the master did not send
  bool holds_clock = false;
  unsigned holds_data = 0;                      // clocks until it releases the data line
  unsigned clocks = 0;                          // clocks outside of transfers
  std::vector<std::vector<std::byte>> written;  // messages, in order

  void pass_microsecond();
  bool interrupt() const;
  bool is_on() const { return enabled_; }

  std::uint32_t read(std::uintptr_t address) override;
  void write(std::uintptr_t address, std::uint32_t value) override;

private:
  enum class Phase { idle, writing, reading, wrong, stopping };

  void wire_lines();
  void watch_clock();
  void start(Phase phase);
  void next_byte();
  void write_byte();
  void read_byte();
  void refuse(std::uint32_t error);
  void stop();
  void write_own(std::uintptr_t offset, std::uint32_t value);
  void configure(std::uintptr_t offset, std::uint32_t value);
  static constexpr unsigned kByte = 23;  // microseconds for nine bits at 390 kHz

  std::uintptr_t base_;
  Pin clock_, data_;
  bool enabled_ = false, was_high_ = true;
  bool confused_ = false;  // by a stop that it did not send: until it is switched off
  Phase phase_ = Phase::idle;
  unsigned left_ = 0, done_ = 0, place_ = 0;
  std::uint32_t stopped_ = 0, error_ = 0, errors_ = 0, shortcuts_ = 0, interrupts_ = 0;
  std::uint32_t of_ = 0, frequency_ = 0x0400'0000, clock_pin_ = ~0U, data_pin_ = ~0U;
  std::uint32_t read_to_ = 0, read_count_ = 0, write_from_ = 0, write_count_ = 0;
  std::uint32_t has_read_ = 0, has_written_ = 0;
};

}  // namespace robosync::tests
