// What the portable runtime needs of a board. Implemented by boards/NAME/ and, for
// the simulated robot, by sim/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "link/messages.hpp"
#include "runtime-m4/boards/panel_output.hpp"
#include "runtime-m4/boards/store.hpp"
#include "runtime-m4/policy/pins.hpp"
#include "runtime-m4/policy/player.hpp"

namespace robosync::boards {

// What the link's line tells, from interrupts of the kernel's level.
struct LineEvents {
  // Bytes have come; or, after a link_write() that took less than it was given, there is room again. At worst
  // for nothing.
  void (*ready)(void* argument) = nullptr;
  // A stop frame has come (link::StopDetector), though nobody may have read it yet, nor had room for it.
  void (*stop)(void* argument) = nullptr;
  void* argument = nullptr;
};

// Counts of analog inputs: 12 bits.
inline constexpr std::uint16_t kAnalogFull = 4095;

// How it stands on the I2C buses.
struct BusState {
  std::uint16_t clears = 0;  // a device held the data line down, and was given clocks to let go
  std::uint8_t held = 0;     // bit b: a line of bus b was held down when somebody wanted it last
};

inline constexpr std::size_t kMostSelected = 2;
// Of a board that has one.
inline constexpr std::uint8_t kPlayerLine = vm::kFirstPlayerLine;

class Board {
public:
  virtual const char* name() const = 0;
  virtual link::ResetReason reset_reason() const = 0;

  // What programs may do with the pins. It never changes.
  virtual const policy::BoardPins& pins() const = 0;
  // One I2C transaction: writes `out`, then (repeated start) reads `in`. False when the device does
  // not acknowledge, a line is held down or there is no such bus. Takes at most a few milliseconds; where a line is held
  // down for good, as long only once.
  virtual bool i2c_transfer(std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
                            std::span<std::byte> in) = 0;
  // What goes to the same device right before the next transfer, in one of its own: for devices with pages. No other
  // transfer comes in between, nor does the next one happen when this has not been acknowledged. At most kMostSelected bytes.
  // False: it is known already that the device does not acknowledge.
  virtual bool i2c_select(std::uint8_t bus, std::uint8_t address,
                          std::span<const std::byte> page) = 0;
  virtual BusState buses() const = 0;
  // Buses with hardware of their own work while the processor does something else, so they are asked twice. While they
  // are asked ahead (i2c_ask(true)), i2c_transfer() only notes what is wanted and has it begin: it gives true where
  // nothing is read, else false. When i2c_busy() is over, the same transfer gives what came of it, at once; what still
  // goes on then is given up. Boards that do not ask ahead give what is wanted when they are asked for it.
  virtual bool i2c_asks_ahead() const { return false; }
  virtual void i2c_ask(bool /*ahead*/) {}
  virtual bool i2c_busy() const { return false; }
  // Is the level of an input (pins()) high? Of another pin: no.
  virtual bool input(std::uint16_t pin) const = 0;
  // Of a sensor with two pins: a pulse of 10 us or a little more goes out on `trigger`, an output, and how long `echo`, an input,
  // is high then is measured while the processor does something else. Two edges are looked at, so that a pin that does not
  // rest costs no more. Nobody but the output guard calls it, and the pulse ends by itself.
  virtual void ping(std::uint16_t /*trigger*/, std::uint16_t /*echo*/) {}
  // … how long that was, in microseconds; 0 when it was not, is still high, or was before. The measurement is over then.
  virtual std::uint32_t take_echo(std::uint16_t /*echo*/) { return 0; }
  // The voltage of an analog input (pins()), 0 to kAnalogFull, which is that of the supply. False when the converter does not
  // answer, or for another pin. Takes some ten microseconds; as long again at most, when there is no answer.
  virtual bool analog(std::uint16_t /*pin*/, std::uint16_t& /*voltage*/) { return false; }
  // A pin that is an output and an analog input is let go, and nothing drives it until it is taken back: it is an output then,
  // and low, as from the start on. Of another pin: nothing. Nobody but the output guard calls it.
  virtual void let_go(std::uint16_t /*pin*/) {}
  virtual void take_back(std::uint16_t /*pin*/) {}
  // Pulse width on a PWM pin in microseconds, 20 ms frame; 0 switches the output off.
  virtual void pwm_write(std::uint16_t pin, std::uint32_t pulse_us) = 0;
  virtual std::uint32_t pwm_read(std::uint16_t pin) const = 0;

  // The enable input of a chip (pins()): its outputs are on from now on, which is a low pin, or off, which is a high one, as it is
  // from the start on. At once, and of another pin: nothing. Nobody but the output guard calls it.
  virtual void enable(std::uint16_t /*pin*/, bool /*on*/) {}

  // The picture on the lights from now on, for boards that have some: bit 5 * row + column, from the top left. 0: dark.
  virtual void show(std::uint32_t /*picture*/) {}

  // The tone of the speaker from now on, for boards that have one, in Hz. 0: silent, at once.
  virtual void sound(std::uint32_t /*hertz*/) {}

  // A command to a sound player on one of the board's serial lines (pins()), at 9,600 baud while the processor does something
  // else. What has not left of the command before is given up. On another line: nothing. Nobody but the output guard calls it.
  virtual void say(std::uint8_t /*line*/, const policy::PlayerCommand& /*command*/) {}

  // A panel of lights on one of its pins (pins()).
  virtual PanelOutput& panel() { return no_panel; }

  // What outlasts a reset; nullptr where the board has nothing for it.
  virtual Store* store() { return nullptr; }

  // The link's serial line. Both return at once with the number of bytes moved.
  virtual std::size_t link_write(std::span<const std::byte> bytes) = 0;
  virtual std::size_t link_read(std::span<std::byte> bytes) = 0;
  // Starts the line, so that nobody ever has to look.
  virtual void link_start(const LineEvents& events) = 0;

  // Starts the watchdog, and keeps it from resetting the board for another period.
  virtual void watchdog_start() = 0;
  virtual void watchdog_kick() = 0;
  // From a kick to its first time-out, in ms.
  virtual std::uint32_t watchdog_ms() const = 0;

protected:
  ~Board() = default;
};

}  // namespace robosync::boards
