// An I2C bus on one of the chip's masters with DMA (TWIM), at 390 kHz. A data line that is held low gets its clocks within
// 30 us.
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
  bool clock_is_high() const { return is_high(lines_.clock); }
  bool data_is_high() const { return is_high(lines_.data); }
  bool are_high() const { return clock_is_high() && data_is_high(); }
  void take_clock() const;
  void give_clock_back() const;
  void drive_clock(bool high) const;
  static void half_bit();

private:
  static bool is_high(const Pin& pin) { return pin.levels().has(pin.mask()); }
  bool is_whole() const;

  Twim master_;
  Lines lines_;
  std::uint32_t to_write_ = 0, to_read_ = 0;  // bytes of the running transfer
  bool wrong_ = false;                        // it has failed
};
using I2c = AskedBus<TwimMaster>;

}  // namespace robosync::boards::microbit
