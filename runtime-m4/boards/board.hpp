// What the portable runtime needs from a board. boards/NAME/ implements it, and sim/ for the simulated robot.
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

// Callbacks of the link's line, called from interrupts of the kernel's level.
struct LineEvents {
  // Bytes have come; or, after a link_write() that took less than it was given, there is room again. It may be
  // called without cause.
  void (*ready)(void* argument) = nullptr;
  // A stop frame has come (link::StopDetector). It may not have been read yet, or may have found no room.
  void (*stop)(void* argument) = nullptr;
  void* argument = nullptr;
};

// The full scale of analog inputs: 12 bits.
inline constexpr std::uint16_t kAnalogFull = 4095;

// The state of the I2C buses.
struct BusState {
  std::uint16_t clears = 0;  // a device held the data line low and got clocks to release it
  std::uint8_t held = 0;     // bit b: a line of bus b was held low at its last use
};

// A microphone's sound comes in blocks of 20 ms: 8,000 samples a second.
inline constexpr std::size_t kSoundBlock = 160;
using SoundBlock = std::span<std::int16_t, kSoundBlock>;

inline constexpr std::size_t kMostSelected = 2;
// The serial line to a sound player, on boards that have one.
inline constexpr std::uint8_t kPlayerLine = vm::kFirstPlayerLine;

class Board {
public:
  virtual const char* name() const = 0;
  virtual link::ResetReason reset_reason() const = 0;

  // What programs may do with the pins. Never changes.
  virtual const policy::BoardPins& pins() const = 0;
  // One I2C transaction: writes `out`, then (repeated start) reads `in`. False when the device does
  // not acknowledge, a line is held low or there is no such bus. Takes at most a few milliseconds; if a line stays
  // low, only the first call takes that long.
  virtual bool i2c_transfer(std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
                            std::span<std::byte> in) = 0;
  // For devices with pages: writes `page` to the same device right before the next transfer, in its own transfer. No other
  // transfer comes in between, and if this one is not acknowledged, the next does not happen. At most kMostSelected bytes.
  // False: the board already knows that the device does not acknowledge.
  virtual bool i2c_select(std::uint8_t bus, std::uint8_t address,
                          std::span<const std::byte> page) = 0;
  virtual BusState buses() const = 0;
  // Buses with their own hardware work in the background, so each transfer is requested twice. After i2c_ask(true),
  // i2c_transfer() only queues the transfer: it returns true if nothing is read, otherwise false. Once i2c_busy() is
  // false, the same call after i2c_ask(false) returns the result immediately; a transfer still running then is given up.
  // Boards that do not ask ahead perform a transfer when it is requested.
  virtual bool i2c_asks_ahead() const { return false; }
  virtual void i2c_ask(bool /*ahead*/) {}
  virtual bool i2c_busy() const { return false; }
  // Is the level of an input (pins()) high? False for any other pin.
  virtual bool input(std::uint16_t pin) const = 0;
  // For a sensor with two pins: sends a pulse of 10 us or a little more on `trigger`, an output, and then measures in the
  // background how long `echo`, an input, is high. Only two edges are handled, so a noisy pin costs no more. The pulse ends
  // on its own. Only the output guard calls this.
  virtual void ping(std::uint16_t /*trigger*/, std::uint16_t /*echo*/) {}
  // Ends the measurement. Returns how long `echo` was high, in microseconds; 0 if it was not, still is, or already was
  // before the pulse.
  virtual std::uint32_t take_echo(std::uint16_t /*echo*/) { return 0; }
  // The voltage of an analog input (pins()), 0 to kAnalogFull, which is the supply voltage. False when the converter does not
  // answer, or for any other pin. Takes tens of microseconds; at most twice as long when there is no answer.
  virtual bool analog(std::uint16_t /*pin*/, std::uint16_t& /*voltage*/) { return false; }
  // The microphone, on boards that have one: on while a program uses it. Meanwhile analog() may give false. Only the output
  // guard calls this.
  virtual void listen(bool /*on*/) {}
  // The last 20 ms of its sound, without its mean voltage; 32767 is the loudest. False if there are none, each counts once, or
  // if samples were lost: then the next ones do not follow on the last. Called every 20 ms.
  virtual bool hear(SoundBlock /*sound*/) { return false; }
  // For a pin that is both an output and an analog input: nothing drives it between let_go() and take_back(). Then it is an
  // output again, and low, as after start-up. No effect on other pins. Only the output guard calls these.
  virtual void let_go(std::uint16_t /*pin*/) {}
  virtual void take_back(std::uint16_t /*pin*/) {}
  // Pulse width on a PWM pin in microseconds, 20 ms frame; 0 switches the output off.
  virtual void pwm_write(std::uint16_t pin, std::uint32_t pulse_us) = 0;
  virtual std::uint32_t pwm_read(std::uint16_t pin) const = 0;

  // The enable input of a chip (pins()): switches the chip's outputs on (the pin is low) or off (it is high, as after start-up).
  // Takes effect immediately. No effect on other pins. Only the output guard calls this.
  virtual void enable(std::uint16_t /*pin*/, bool /*on*/) {}

  // Shows a picture on the lights, on boards that have them: bit 5 * row + column, from the top left. 0: dark.
  virtual void show(std::uint32_t /*picture*/) {}

  // Plays a tone on the speaker, on boards that have one, in Hz. 0: silent immediately.
  virtual void sound(std::uint32_t /*hertz*/) {}

  // Sends a command to a sound player on one of the board's serial lines (pins()), at 9,600 baud, in the background. The rest
  // of an unfinished command is dropped. No effect on other lines. Only the output guard calls this.
  virtual void say(std::uint8_t /*line*/, const policy::PlayerCommand& /*command*/) {}

  // A panel of lights on one of its pins (pins()).
  virtual PanelOutput& panel() { return no_panel; }

  // Memory that survives a loss of power; nullptr if the board has none.
  virtual Store* store() { return nullptr; }

  // The link's serial line. Both return immediately with the number of bytes moved.
  virtual std::size_t link_write(std::span<const std::byte> bytes) = 0;
  virtual std::size_t link_read(std::span<std::byte> bytes) = 0;
  // Starts the line. From then on `events` report, so nothing has to poll.
  virtual void link_start(const LineEvents& events) = 0;

  // Start the watchdog, and keep it from resetting the board for another period.
  virtual void watchdog_start() = 0;
  virtual void watchdog_kick() = 0;
  // Time from a kick to the watchdog's first time-out, in ms.
  virtual std::uint32_t watchdog_ms() const = 0;

protected:
  ~Board() = default;
};

}  // namespace robosync::boards
