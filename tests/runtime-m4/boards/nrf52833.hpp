// A model of the parts of an nRF52833 that the micro:bit's firmware drives and no emulator has, from Nordic's Product
// Specification: pins (GPIO), PWM0 to PWM3, TIMER1, the watchdog, and the reset reason. It is independent of the drivers:
// addresses, fields and values are defined here again.
//
// Everything else that these peripherals can do is left out; using it throws an exception.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "tests/runtime-m4/boards/registers.hpp"

namespace robosync::tests {

class Nrf52833 : public RegisterModel {
public:
  using Pin = std::pair<unsigned, unsigned>;  // {1, 2} is P1.02
  enum class Level { floating, low, high };

  // When a PWM module reads the values of a period: at the beginning of the period before, or at its end. Nordic does not say.
  enum class Fetch { early, late };

  explicit Nrf52833(Fetch fetch = Fetch::late) : fetch_(fetch) {}

  std::uint32_t read(std::uintptr_t address) override;
  void write(std::uintptr_t address, std::uint32_t value) override;

  // Throws if two peripherals have the pin, or if it is not configured for the one that has it.
  Level level(Pin pin) const;
  // The wire at the pin drives this level, or none.
  void wire(Pin pin, std::optional<bool> high) { wired_[pin] = high; }
  void pass_microsecond();
  // A module requests its interrupt.
  bool pwm_interrupt() const;

  struct Watchdog {
    bool runs = false;
    std::uint32_t reload = 0xFFFF'FFFF, asked = 1, configuration = 1, left = 0;
    bool expired = false;
  };
  const Watchdog& watchdog() const { return watchdog_; }
  struct RowTimer {  // TIMER1
    bool runs = false;
    std::uint32_t reached = 0, shortcuts = 0, interrupts = 0, prescaler = 4, value = 0;
    // It requests its interrupt each time it reaches its value.
    bool asks() const { return runs && (interrupts & 1U << 16) != 0 && (shortcuts & 1) != 0; }
    std::uint32_t period_us() const { return (value << prescaler) / 16; }
  };
  const RowTimer& row_timer() const { return row_timer_; }
  // Counts of the 32,768 Hz oscillator.
  void pass_slow_counts(std::uint32_t counts);
  std::uint32_t configuration_of(Pin pin) const {
    return ports_[pin.first].configuration[pin.second];
  }
  bool is_set(Pin pin) const { return (ports_[pin.first].out >> pin.second & 1) != 0; }
  void reset_by(std::uint32_t cause) { reset_reason_ |= cause; }

private:
  struct Sequence {
    std::uint32_t values = 0, count = 0, refresh = 1, end_delay = 0;
  };
  struct Pwm {
    bool enabled = false, plays = false;
    std::uint32_t shortcuts = 0, interrupts = 0, period_ended = 0;
    std::uint32_t mode = 0, top = 0x3FF, prescaler = 0, decoder = 0, loop = 0;
    std::array<Sequence, 2> sequences;
    std::array<std::uint32_t, 4> pins{~0U, ~0U, ~0U, ~0U};
    unsigned counter = 0, sequence = 0;
    std::uint32_t loops_left = 0;
    std::array<std::uint16_t, 4> fetched{}, at_work{};
    bool high(unsigned channel) const;
    std::optional<unsigned> channel_at(std::uint32_t pin) const;
  };
  struct Port {
    std::uint32_t out = 0;
    std::array<std::uint32_t, 32> configuration{};
    Port() { configuration.fill(0b10); }
  };

  std::uint32_t read(const Pwm& pwm, std::uintptr_t offset) const;
  void write(Pwm& pwm, std::uintptr_t offset, std::uint32_t value);
  static void configure(Pwm& pwm, std::uintptr_t offset, std::uint32_t value);
  void play(Pwm& pwm);
  void fetch(Pwm& pwm);
  void begin_period(Pwm& pwm);
  void end_period(Pwm& pwm);
  std::uint32_t read_port(unsigned number, std::uintptr_t offset) const;
  void write_port(Port& port, std::uintptr_t offset, std::uint32_t value);
  void write_watchdog(std::uintptr_t offset, std::uint32_t value);

  void write_row_timer(std::uintptr_t offset, std::uint32_t value);

  Fetch fetch_;
  std::array<Pwm, 4> pwms_;
  std::array<Port, 2> ports_;
  std::map<Pin, std::optional<bool>> wired_;
  Watchdog watchdog_;
  RowTimer row_timer_;
  std::uint32_t reset_reason_ = 0;
};

}  // namespace robosync::tests
