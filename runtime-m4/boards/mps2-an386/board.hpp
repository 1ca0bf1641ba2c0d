// The MPS2 board with AN386 (Cortex-M4, 25 MHz), as emulated by QEMU's mps2-an386.
//
// It has no PWM and no pins that could be read, so they are words in memory. The host reads the PWM pins,
// `robosync_virtual_pwm`, and writes the input pins, bits of `robosync_virtual_inputs`. It writes the length of each echo,
// `robosync_virtual_echoes` (trigger pins have no effect), the edges of each encoder, `robosync_virtual_edges`, and the counts of
// each analog input, `robosync_virtual_analog`. The wheels of a drive with encoders turn by themselves (policy/virtual_wheels.hpp).
// Everything above this file is the same as with real pins.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/common/asking_board.hpp"
#include "runtime-m4/boards/common/reset.hpp"
#include "runtime-m4/boards/mps2-an386/eeprom.hpp"
#include "runtime-m4/boards/mps2-an386/i2c.hpp"
#include "runtime-m4/boards/mps2-an386/registers.hpp"
#include "runtime-m4/boards/mps2-an386/spi.hpp"
#include "runtime-m4/boards/mps2-an386/uart.hpp"
#include "runtime-m4/boards/pins.hpp"

inline constexpr std::size_t kVirtualPwmPins = 36;
extern "C" std::array<volatile std::uint32_t, kVirtualPwmPins> robosync_virtual_pwm;  // pulse, µs
extern "C" volatile std::uint32_t robosync_virtual_inputs;  // bit i: pin kFirstInput + i is high
inline constexpr std::uint16_t kFirstInput = 40;
inline constexpr std::uint16_t kVirtualInputs = 4;
// How long each input is high after a pulse on a trigger pin, in microseconds; 0: no echo.
extern "C" std::array<volatile std::uint32_t, kVirtualInputs> robosync_virtual_echoes;
// The edges of an encoder at each input since power-up; the program counts them from where it begins.
extern "C" std::array<volatile std::uint32_t, kVirtualInputs> robosync_virtual_edges;
// The counts of each analog input, up to boards::kAnalogFull; more: it does not answer.
inline constexpr std::uint16_t kFirstAnalog = 44;
inline constexpr std::uint16_t kVirtualAnalog = 4;
extern "C" std::array<volatile std::uint32_t, kVirtualAnalog> robosync_virtual_analog;

// The level of each pin at an enable input: 1 is high, which is off.
inline constexpr std::uint16_t kFirstEnable = 36;
inline constexpr std::uint16_t kVirtualEnables = 2;
extern "C" std::array<volatile std::uint32_t, kVirtualEnables> robosync_virtual_enables;

namespace robosync::boards::mps2 {

struct Buses {  // for AskingBoard
  using Spi = WaitingSpi;
  static constexpr std::array<I2c, 1> i2c() { return {I2c(LineMaster())}; }
};

}  // namespace robosync::boards::mps2

extern template class robosync::boards::AskingBoard<robosync::boards::mps2::Buses>;

namespace robosync::boards::mps2 {

class Board final : public AskingBoard<Buses> {
public:
  // First time-out: NMI, outputs off. Second time-out, after as long again: reset.
  static constexpr std::uint32_t kWatchdogMs = 50;

  // Starts the kernel's clock.
  Board();

  const char* name() const override { return "mps2-an386"; }
  ResetReason reset_reason() const override { return last_reset(); }
  const policy::BoardPins& pins() const override { return boards::kPins; }
  static_assert(!meet(kOutputs, kInputs) && !meet(kOutputs, kAnalog), "let_go() does nothing here");
  bool input(std::uint16_t pin) const override;
  Store* store() override { return &eeprom_; }
  std::uint32_t take_echo(std::uint16_t echo) override;
  bool take_edges(unsigned number, std::uint16_t a, std::uint8_t b, unsigned most,
                  Turned& turned) override;
  policy::EncoderCount edges_so_far(unsigned number) override;
  void end_edges(unsigned number) override;
  policy::VirtualWheels* wheels() override { return &wheels_; }
  bool analog(std::uint16_t pin, std::uint16_t& voltage) override;
  void pwm_write(std::uint16_t pin, std::uint32_t pulse_us) override;
  std::uint32_t pwm_read(std::uint16_t pin) const override;
  void enable(std::uint16_t pin, bool on) override;
  std::size_t link_write(std::span<const std::byte> bytes) override { return uart_.write(bytes); }
  std::size_t link_read(std::span<std::byte> bytes) override { return uart_.read(bytes); }
  void link_start(const LineEvents& events) override;
  void say(std::uint8_t line, const policy::PlayerCommand& command) override;
  void watchdog_start() override;
  void watchdog_kick() override;
  std::uint32_t watchdog_ms() const override { return kWatchdogMs; }

  Uart& uart() { return uart_; }
  Player& player() { return player_; }

private:
  // What has been counted of an encoder before it began, and at its last take; and how many edges that one allowed.
  struct Counted {
    std::uint32_t begin = 0, last = 0;
    std::uint16_t place = 0, most = 0;
    std::uint8_t losses = 0;
    bool begun = false;
  };
  std::array<Counted, vm::kMaxEncoders> counted_{};
  policy::VirtualWheels wheels_;
  Uart uart_;
  Player player_;
  Eeprom eeprom_{i2c(0)};
};

extern Board board;

}  // namespace robosync::boards::mps2
