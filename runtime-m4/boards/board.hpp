// What the portable runtime needs from a board. boards/NAME/ implements it, and sim/ for the simulated robot.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "link/messages.hpp"
#include "runtime-m4/boards/panel_output.hpp"
#include "runtime-m4/boards/store.hpp"
#include "runtime-m4/policy/encoder_count.hpp"
#include "runtime-m4/policy/pins.hpp"
#include "runtime-m4/policy/player.hpp"
#include "runtime-m4/policy/virtual_wheels.hpp"

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

// What a sensor reads of its pin.
enum class Reads : std::uint8_t { voltage, level };

// What has been counted of an encoder.
struct Turned {
  std::int32_t edges = 0;  // since it began: forward, less those backward
  std::uint32_t ago = 0;   // how long ago the last one was, in microseconds
  bool begun = false;      // it begins now, with no edge
};

// A part of the board that needs no wiring, in the order of the inputs of the driver board_part.
enum class Part : std::uint8_t { logo, thermometer };

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

// Two blocks of a device's registers. The first is `split` bytes long, and not empty.
struct TwoBlocks {
  std::byte first, second;  // the first register of each
  std::uint8_t split;
};

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
  // One SPI transfer while the part's select pin (pins()) is low, in mode 0, at the board's rate, 1 MHz at most: writes `out`, then
  // reads `in`; together at most vm::kMostSpiBytes. False if it does not end, or there is no such bus. SPI has no acknowledge: without a part, `in` is
  // whatever the line shows.
  virtual bool spi_transfer(std::uint8_t /*bus*/, std::uint16_t /*select*/,
                            std::span<const std::byte> /*out*/, std::span<std::byte> /*in*/) {
    return false;
  }
  // Reads both blocks into `in`, one right behind the other: each as i2c_transfer() does, but the result is that of both.
  virtual bool i2c_read_two(std::uint8_t bus, std::uint8_t address, TwoBlocks blocks,
                            std::span<std::byte> in) {
    const bool first = i2c_transfer(bus, address, std::array{blocks.first}, in.first(blocks.split));
    return i2c_transfer(bus, address, std::array{blocks.second}, in.subspan(blocks.split)) && first;
  }
  // Between spi_open() and spi_close() an SPI bus has its pins, and the select pins that were named are high. Otherwise these pins
  // are what they are without the bus. Boards whose bus has pins of its own need neither. Only the output guard calls these.
  virtual void spi_open(std::uint8_t /*bus*/, std::uint16_t /*select*/) {}
  virtual void spi_close() {}
  virtual BusState buses() const = 0;
  // Buses with their own hardware work in the background, so each transfer is requested twice. After ask_buses(true),
  // i2c_transfer() and spi_transfer() only queue it: they return true if nothing is read, otherwise false. Once buses_busy() is
  // false, the same call after ask_buses(false) returns the result immediately; a transfer still running then is given up.
  // Boards that do not ask ahead perform a transfer when it is requested. The others say how many ticks ahead: requests of all that is
  // due together take the longer, the slower the bus.
  virtual unsigned buses_ask_ahead() const { return 0; }
  virtual void ask_buses(bool /*ahead*/) {}
  virtual bool buses_busy() const { return false; }
  // Is the level of an input (pins()) high? False for any other pin.
  virtual bool input(std::uint16_t pin) const = 0;
  // For a sensor with two pins: sends a pulse of 10 us or a little more on `trigger`, an output, and then measures in the
  // background how long `echo`, an input, is high. Only two edges are handled, so a noisy pin costs no more. The pulse ends
  // on its own. Only the output guard calls this.
  virtual void ping(std::uint16_t /*trigger*/, std::uint16_t /*echo*/) {}
  // Ends the measurement. Returns how long `echo` was high, in microseconds; 0 if it was not, still is, or already was
  // before the pulse.
  virtual std::uint32_t take_echo(std::uint16_t /*echo*/) { return 0; }
  // Counts the edges of a wheel's encoder in the background, from the first call on: the edges of `a`, one of the inputs of an echo.
  // An edge goes forward if `a` is not as the input `b` then; with b = vm::kNoSecondPin all do. Until the next call at most `most`
  // edges are counted, and then the pin is ignored, so a noisy wire costs no more than that. False: edges were lost that way, or
  // there is no such input. `number` is below vm::kMaxEncoders.
  virtual bool take_edges(unsigned /*number*/, std::uint16_t /*a*/, std::uint8_t /*b*/,
                          unsigned /*most*/, Turned& /*turned*/) {
    return false;
  }
  // What take_edges() has counted, with the edges since its last call; zeros before its first call. Allows no more of them.
  virtual policy::EncoderCount edges_so_far(unsigned /*number*/) { return {}; }
  // Only the output guard calls this.
  virtual void end_edges(unsigned /*number*/) {}
  // The wheels of a drive on boards that have no real ones, else null: the output guard counts what they turn besides the edges
  // above. Only it uses them.
  virtual policy::VirtualWheels* wheels() { return nullptr; }
  // The voltage of an analog input (pins()), 0 to kAnalogFull, which is the supply voltage. False when the converter does not
  // answer, or for any other pin. Takes tens of microseconds; at most twice as long when there is no answer.
  virtual bool analog(std::uint16_t /*pin*/, std::uint16_t& /*voltage*/) { return false; }
  // The microphone, on boards that have one: on while a program uses it. Meanwhile analog() may give false. Only the output
  // guard calls this.
  virtual void listen(bool /*on*/) {}
  // The last 20 ms of its sound, without its mean voltage; 32767 is the loudest. False if there are none, each counts once, or
  // if samples were lost: then the next ones do not follow on the last. Called every 20 ms.
  virtual bool hear(SoundBlock /*sound*/) { return false; }
  // Measures a part of the board (vm::is_board_part()), in the background: gives the previous result, and begins the next one.
  // The logo is 1 while it is touched, and gives each result twice; the thermometer counts quarters of a degree. False while
  // there is no result yet, and for a part that the board does not have.
  virtual bool measure(Part /*part*/, std::int32_t& /*raw*/) { return false; }
  // For a pin that is an output, and also an input: nothing drives it between let_go() and take_back(). Then it is an output
  // again, and low, as after start-up. If its level is read, it is pulled up. No effect on other pins. Only the output guard
  // calls these.
  virtual void let_go(std::uint16_t /*pin*/, Reads /*what*/) {}
  virtual void take_back(std::uint16_t /*pin*/) {}
  // Pulse width on a PWM pin in microseconds, 20 ms frame; 0 switches the output off.
  virtual void pwm_write(std::uint16_t pin, std::uint32_t pulse_us) = 0;
  virtual std::uint32_t pwm_read(std::uint16_t pin) const = 0;

  // The enable input of a chip (pins()): switches the chip's outputs on (the pin is low) or off (it is high, as after start-up).
  // Takes effect immediately. No effect on other pins. Only the output guard calls this, and spi_transfer() does the same.
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
