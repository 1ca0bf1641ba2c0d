// The micro:bit V2: an nRF52833 (Cortex-M4F, 64 MHz, 512 KB of flash, 128 KB of RAM). QEMU has its ancestor, the micro:bit
// with an nRF51: scripts/emulator makes one with a Cortex-M4 of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/common/serial_line.hpp"
#include "runtime-m4/boards/microbit-v2/resets.hpp"
#include "runtime-m4/boards/microbit-v2/uart.hpp"
#include "runtime-m4/boards/pins.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"

namespace robosync::boards::microbit {

struct Uart0 : Uart {  // for SerialLine
  static void start() {
    open();
    port::core::enable_interrupt(uart::kInterrupt);
  }
  static void begin_to_send() {
    wants_to_send(true);
    port::core::pend_interrupt(uart::kInterrupt);
  }
  static void nothing_to_send() { wants_to_send(false); }
  using Uart::wants_to_send;
};
using Line = SerialLine<Uart0>;

class Board final : public boards::Board {
public:
  // Starts the clock of the core and that of the kernel.
  Board();

  const char* name() const override { return "microbit-v2"; }
  link::ResetReason reset_reason() const override;
  const policy::BoardPins& pins() const override { return boards::kPins; }
  bool i2c_transfer(std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
                    std::span<std::byte> in) override;
  BusState buses() const override { return {}; }
  bool input(std::uint16_t pin) const override;
  void pwm_write(std::uint16_t pin, std::uint32_t pulse_us) override;
  std::uint32_t pwm_read(std::uint16_t pin) const override;
  void show(std::uint32_t picture) override;
  std::size_t link_write(std::span<const std::byte> bytes) override { return line_.write(bytes); }
  std::size_t link_read(std::span<std::byte> bytes) override { return line_.read(bytes); }
  void link_start(const LineEvents& events) override { line_.start(events); }
  void watchdog_start() override { start_watchdog(); }
  void watchdog_kick() override { kick_watchdog(); }

  Line& line() { return line_; }

private:
  ChipReset chip_reset_;
  Line line_;
};

}  // namespace robosync::boards::microbit
