// The micro:bit V2: an nRF52833 (Cortex-M4F, 64 MHz, 512 KB of flash, 128 KB of RAM). QEMU has its predecessor, the micro:bit
// with an nRF51; scripts/emulator turns that into one with a Cortex-M4.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/common/asking_board.hpp"
#include "runtime-m4/boards/common/flash_store.hpp"
#include "runtime-m4/boards/common/serial_line.hpp"
#include "runtime-m4/boards/microbit-v2/flash.hpp"
#include "runtime-m4/boards/microbit-v2/i2c.hpp"
#include "runtime-m4/boards/microbit-v2/panel.hpp"
#include "runtime-m4/boards/microbit-v2/resets.hpp"
#include "runtime-m4/boards/microbit-v2/spi.hpp"
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

struct OwnFlash : Flash {  // for FlashStore
  // The line's handler takes the bytes that came in the meantime.
  static Erasing erase(std::uint32_t page, unsigned call) {
    const Erasing state = Flash::erase(page, call);
    if (Uart::holds()) port::core::pend_interrupt(uart::kInterrupt);
    return state;
  }
};

struct Buses {  // for AskingBoard
  using Spi = PartBus;
  // 0: the edge connector's, pins 19 and 20; 1: the bus of the parts on the board.
  static constexpr std::array<I2c, 2> i2c() {
    return {I2c({kTwim1, {.clock = {0, 26}, .data = {1, 0}}}),
            I2c({kTwim0, {.clock = {0, 8}, .data = {0, 16}}})};
  }
};

}  // namespace robosync::boards::microbit

extern template class robosync::boards::AskingBoard<robosync::boards::microbit::Buses>;

namespace robosync::boards::microbit {

class Board final : public AskingBoard<Buses> {
public:
  static constexpr std::uint32_t kWatchdogMs = 100;

  // Starts the core's clock and the kernel's.
  Board();

  const char* name() const override { return "microbit-v2"; }
  link::ResetReason reset_reason() const override;
  const policy::BoardPins& pins() const override { return boards::kPins; }
  bool input(std::uint16_t pin) const override;
  void ping(std::uint16_t trigger, std::uint16_t echo) override;
  std::uint32_t take_echo(std::uint16_t echo) override;
  bool take_edges(unsigned number, std::uint16_t a, std::uint8_t b, unsigned most,
                  Turned& turned) override;
  policy::EncoderCount edges_so_far(unsigned number) override;
  void end_edges(unsigned number) override;
  bool analog(std::uint16_t pin, std::uint16_t& voltage) override;
  void listen(bool on) override;
  bool hear(SoundBlock sound) override;
  bool measure(Part part, std::int32_t& raw) override;
  void let_go(std::uint16_t pin, Reads what) override;
  void take_back(std::uint16_t pin) override;
  void pwm_write(std::uint16_t pin, std::uint32_t pulse_us) override;
  std::uint32_t pwm_read(std::uint16_t pin) const override;
  void enable(std::uint16_t pin, bool on) override;
  Store* store() override { return &store_; }
  void show(std::uint32_t picture) override;
  void sound(std::uint32_t hertz) override;
  void say(std::uint8_t line, const policy::PlayerCommand& command) override;
  PanelOutput& panel() override { return panel_output(); }
  std::size_t link_write(std::span<const std::byte> bytes) override { return line_.write(bytes); }
  std::size_t link_read(std::span<std::byte> bytes) override { return line_.read(bytes); }
  void link_start(const LineEvents& events) override { line_.start(events); }
  void watchdog_start() override { start_watchdog(kWatchdogMs); }
  void watchdog_kick() override { kick_watchdog(); }
  std::uint32_t watchdog_ms() const override { return kWatchdogMs; }

  Line& line() { return line_; }

private:
  ChipReset chip_reset_;
  Line line_;
  FlashStore<OwnFlash> store_{flash::kBytes - ROBOSYNC_STORE_BYTES,
                              ROBOSYNC_STORE_BYTES};  // the end of the flash
};

extern Board board;

}  // namespace robosync::boards::microbit
