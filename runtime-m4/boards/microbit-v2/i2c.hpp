// An I2C bus by one of the chip's masters with memory access of its own (TWIM), at 390 kHz. A data line that is held down gets its
// clocks in 30 us.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/common/asked_bus.hpp"
#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit {

class TwimMaster {  // for AskedBus
public:
  struct Lines {
    Pin clock, data;
  };
  constexpr TwimMaster(Twim master, Lines lines) : master_(master), lines_(lines) {}

  void start() const;
  void begin(std::uint8_t address, std::span<const std::byte> out, std::span<std::byte> in);
  Transfer on_interrupt();
  void let_go() const;
  bool clock_is_high() const;
  bool data_is_high() const;
  void take_clock() const;
  void give_clock_back() const;
  void drive_clock(bool high) const;
  static void half_bit();

private:
  Twim master_;
  Lines lines_;
  bool wrong_ = false;  // the transfer that runs
};
using I2c = AskedBus<TwimMaster>;

}  // namespace robosync::boards::microbit
