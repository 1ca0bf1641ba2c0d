// The MPS2 board with AN386 (Cortex-M4, 25 MHz), as QEMU's mps2-an386 has it.
//
// It has no PWM. PWM pins are words in memory, `robosync_virtual_pwm`, which the host reads through
// the debugger; everything above this file is as it would be on real pins.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "link/messages.hpp"
#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/mps2-an386/i2c.hpp"
#include "runtime-m4/boards/mps2-an386/registers.hpp"
#include "runtime-m4/boards/mps2-an386/uart.hpp"

inline constexpr std::size_t kVirtualPwmPins = 32;
extern "C" std::array<volatile std::uint32_t, kVirtualPwmPins> robosync_virtual_pwm;  // pulse, µs

namespace robosync::boards::mps2 {

// What link::Status::reset_reason says.
enum class ResetReason : std::uint8_t { power, watchdog, software };

class Board final : public boards::Board {
public:
  // Reads why the board was reset, and forgets it. Starts the clock that threads are timed with.
  Board();

  const char* name() const override { return "mps2-an386"; }
  std::uint8_t reset_reason() const override { return static_cast<std::uint8_t>(reset_reason_); }
  bool i2c_transfer(std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
                    std::span<std::byte> in) override;
  void pwm_write(std::uint16_t pin, std::uint32_t pulse_us) override;
  std::uint32_t pwm_read(std::uint16_t pin) const override;
  std::size_t link_write(std::span<const std::byte> bytes) override { return uart_.write(bytes); }
  std::size_t link_read(std::span<std::byte> bytes) override { return uart_.read(bytes); }
  void watchdog_start() override;
  void watchdog_kick() override;

  // The fault that made the firmware reset itself before this start, or null.
  const link::Fault* last_words() const { return has_last_words_ ? &last_words_ : nullptr; }
  Uart& uart() { return uart_; }

private:
  Uart uart_;
  I2c i2c_{kI2c0};
  ResetReason reset_reason_ = ResetReason::power;
  bool has_last_words_ = false;
  link::Fault last_words_{};
};

// Legal in any state of the machine, fault handlers and NMI included.
void switch_outputs_off();
// Switches the outputs off, keeps `fault` for the next start and resets.
[[noreturn]] void reset_after(const link::Fault& fault);

}  // namespace robosync::boards::mps2

// The board of this firmware, defined in main.cpp; the interrupt handlers need it.
extern robosync::boards::mps2::Board robosync_board;
