// A model of the peripherals that make the pulses of an STM32L475, from RM0351: the clocks of ports and timers (RCC), the pins'
// functions and levels, including outputs (GPIO), and timers 2 to 5 counting up in PWM mode 1, with preloaded values. It is
// independent of the driver: addresses, fields and the wiring of the pins are defined here again.
//
// Everything else that these peripherals can do is left out; using it throws an exception.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <utility>

#include "tests/runtime-m4/boards/registers.hpp"

namespace robosync::tests {

class Stm32Timers : public RegisterModel {
public:
  using Pin = std::pair<char, unsigned>;  // {'A', 5} is PA5

  enum class Level { floating, low, high };

  std::uint32_t read(std::uintptr_t address) override;
  void write(std::uintptr_t address, std::uint32_t value) override;

  Level level(Pin pin) const;
  // The wire at the pin drives this level, or none.
  void wire(Pin pin, std::optional<bool> high) { wired_[pin] = high; }
  // One microsecond passes, for timers whose prescaler makes that one count at 80 MHz. Throws for others.
  void pass_microsecond();

private:
  struct Channel {
    std::uint32_t written = 0;  // compare, as read back
    std::uint32_t counts = 0;   // compare, as in effect
    std::uint32_t mode = 0;     // the byte of CCMR
    bool enabled = false;
  };
  struct Timer {
    bool on = false;
    std::uint32_t control = 0, prescaler_written = 0, prescaler = 0, last_written = 0xFFFF,
                  last = 0xFFFF, count = 0;
    std::array<Channel, 4> channels;
    void update();
    std::uint32_t read(std::uintptr_t offset) const;
    void write(std::uintptr_t offset, std::uint32_t value);
    void write_modes(unsigned first, std::uint32_t value);
    bool high(unsigned channel) const;
  };
  struct Port {
    std::uint32_t modes = 0, pulls = 0, speeds = 0;
    std::array<std::uint32_t, 2> functions{};
    std::uint32_t outputs = 0;
  };

  bool has_clock(unsigned timer) const { return (timer_clocks_ >> timer & 1) != 0; }
  std::uint32_t* of_port(std::uintptr_t address);
  void write_port(std::uintptr_t address, std::uint32_t value);
  std::uint32_t levels(char name) const;

  std::uint32_t port_clocks_ = 0, timer_clocks_ = 0;
  std::array<Timer, 4> timers_;  // 2 to 5
  // Their reset values: all analog, except the debugger's pins.
  std::map<char, Port> ports_{{'A', {0xABFF'FFFF, 0x6400'0000, 0x0C00'0000, {}}},
                              {'B', {0xFFFF'FEBF, 0x0000'0100, 0, {}}},
                              {'C', {0xFFFF'FFFF, 0, 0, {}}},
                              {'D', {0xFFFF'FFFF, 0, 0, {}}}};
  std::map<Pin, std::optional<bool>> wired_;
};

}  // namespace robosync::tests
