// An I2C bus on one of the chip's masters and two channels of DMA1, at 390 kHz at most. A data line that is held low gets its
// clocks within 30 us.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/common/asked_bus.hpp"
#include "runtime-m4/boards/stm32l4/wiring.hpp"

namespace robosync::boards::stm32l4 {

class I2cMaster {  // for AskedBus
public:
  constexpr explicit I2cMaster(const Bus& wires)
      : wires_(wires), lines_(1U << wires.clock | 1U << wires.data) {}

  // The port must have its clock.
  void start() const;
  void begin(std::uint8_t address, std::span<const std::byte> out, std::span<std::byte> in);
  Transfer on_interrupt();
  void let_go() const;
  bool clock_is_high() const { return is_high(wires_.clock); }
  bool data_is_high() const { return is_high(wires_.data); }
  bool are_high() const { return (kPortOfI2c.levels().read() & lines_) == lines_; }
  void take_clock() const;
  void give_clock_back() const;
  void drive_clock(bool high) const;
  static void half_bit();

private:
  static bool is_high(unsigned pin) { return kPortOfI2c.levels().has(1U << pin); }
  void switch_off() const;

  Bus wires_;
  std::uint32_t lines_;        // bits of the pins
  std::uint32_t reading_ = 0;  // command for the master after the write; 0: nothing is read
  bool wrong_ = false;         // the running transfer has failed
};
using I2c = AskedBus<I2cMaster>;

constexpr I2cMaster i2c_master(std::size_t bus) {
  return I2cMaster(wiring::kBuses[bus]);
}

}  // namespace robosync::boards::stm32l4
