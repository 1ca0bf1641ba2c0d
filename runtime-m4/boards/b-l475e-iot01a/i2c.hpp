// An I2C bus by one of the chip's masters and two channels of DMA1, at 390 kHz at most. A data line that is held down gets its clocks in
// 30 us.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/b-l475e-iot01a/registers.hpp"
#include "runtime-m4/boards/common/asked_bus.hpp"

namespace robosync::boards::l475 {

class I2cMaster {  // for AskedBus
public:
  struct Wiring {
    unsigned clock, data;           // pins of kPortOfI2c
    DmaChannel to_send, to_memory;  // that hear this master
  };
  constexpr I2cMaster(I2cRegisters registers, Wiring wiring)
      : registers_(registers), wiring_(wiring) {}

  // Its port has its clock.
  void start() const;
  void begin(std::uint8_t address, std::span<const std::byte> out, std::span<std::byte> in);
  Transfer on_interrupt();
  void let_go() const;
  bool clock_is_high() const { return is_high(wiring_.clock); }
  bool data_is_high() const { return is_high(wiring_.data); }
  void take_clock() const;
  void give_clock_back() const;
  void drive_clock(bool high) const;
  static void half_bit();

private:
  static bool is_high(unsigned pin) { return kPortOfI2c.levels().has(1U << pin); }
  void switch_off() const;

  I2cRegisters registers_;
  Wiring wiring_;
  std::uint32_t reading_ = 0;  // what the master is told when all is written; 0: nothing is read
  bool wrong_ = false;         // the transfer that runs
};
using I2c = AskedBus<I2cMaster>;

// 0: of the Arduino header, D15 and D14; 1: of what is on the board.
constexpr I2cMaster i2c_master(unsigned bus) {
  return bus == 0 ? I2cMaster(kI2c1, {.clock = 8, .data = 9, .to_send = {6}, .to_memory = {7}})
                  : I2cMaster(kI2c2, {.clock = 10, .data = 11, .to_send = {4}, .to_memory = {5}});
}

}  // namespace robosync::boards::l475
