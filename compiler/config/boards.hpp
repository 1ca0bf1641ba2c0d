// The boards that rsc knows: stdlib/boards/*.json, built into the library. What a board offers to programs decides which programs
// it accepts.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "vm/image.hpp"

namespace robosync::compiler {

struct BoardText {  // one built-in profile
  std::string_view name;
  std::string_view json;
};
[[nodiscard]] std::span<const BoardText> board_texts();

struct Board {
  std::string name;
  // How robot.json names the board. Unless it does so well, missing parts and pins are not reported.
  enum class Named : std::uint8_t { well, not_at_all, wrongly } named = Named::well;
  std::uint32_t arena_begin = 0;  // address of the memory for programs
  std::uint32_t arena_bytes = 0;
  std::uint32_t step_budget = 0;  // M4 instructions of VM code in one step
  struct Pins {
    std::uint16_t first, last;
    bool power = true;         // of outputs: false if they give pulses for servos only
    vm::ServoPulses pulses{};  // of outputs: the limits for a servo

    [[nodiscard]] std::string text() const;  // "4", "0 to 2"
  };
  std::vector<Pins> outputs;  // pins that a program may drive
  std::vector<Pins> inputs;   // … and read; one may be both, but not in one program
  std::vector<Pins> echoes;   // the inputs that can be that of an echo
  std::vector<Pins> analog;   // pins whose voltage it may read; one may also be an output
  std::vector<Pins> enables;  // for enable inputs of chips, and select inputs on SPI
  std::vector<Pins> panels;   // outputs that can drive a panel of lights
  std::vector<Pins> selects;  // for select inputs on SPI: some of enables and outputs
  Pins spi_pins{1,
                0};  // that the SPI bus has if a robot has a part there; without them, first > last
  std::optional<std::uint16_t> player_pin;  // of the first serial line, if the SPI bus has it, too
  std::uint32_t i2c_buses = 0;              // numbered from 0
  std::uint32_t spi_buses = 0;              // likewise
  struct Reserved {                         // an address on one of them that no program may use
    std::uint8_t bus;
    std::uint16_t address;
    std::string used_for;
  };
  std::vector<Reserved> reserved;
  vm::Value volts = 0;             // the highest voltage that its pins withstand; 0: they have none
  std::uint32_t serial_lines = 0;  // for sound players, from vm::kFirstPlayerLine on
  // How to flash its firmware. nullopt: this board exists only in an emulator.
  struct Flash {
    std::string socket;  // the socket for the cable, in words
    std::string
        usb;  // the USB id of its serial port, "vendor:product", four hexadecimal digits each
    std::string drive;        // its volume name as a drive
    std::string drive_takes;  // the extension of files that the drive accepts
    std::string openocd;      // the scripts for it, separated by spaces
    std::string pyocd;        // its target name
    // The USB id of the chip's boot loader and the address of its flash, separated by a space. Empty: the chip has no DFU.
    std::string dfu;
  };
  std::optional<Flash> flash;
  struct Part {  // soldered to the board, so robot.json does not describe its wiring
    std::string name;
    std::string device;                // its descriptor in stdlib/devices/
    std::optional<std::uint16_t> pin;  // nullopt: a part without one pin, such as the lights
    std::uint8_t bus = 0;              // for a part on I2C
    std::uint16_t address = 0;
  };
  std::vector<Part> parts;

  [[nodiscard]] bool has_output(std::uint16_t pin) const;
  [[nodiscard]] bool gives_power(std::uint16_t pin) const;
  // The shortest and the longest pulse that a servo at the pin gets.
  [[nodiscard]] vm::ServoPulses servo_pulses(std::uint16_t pin) const;
  [[nodiscard]] bool has_input(std::uint16_t pin) const;
  [[nodiscard]] bool has_echo(std::uint16_t pin) const;
  [[nodiscard]] bool has_analog(std::uint16_t pin) const;
  [[nodiscard]] bool has_enable(std::uint16_t pin) const;
  [[nodiscard]] std::vector<Pins> all_pins() const;
  // Null if programs may use it.
  [[nodiscard]] const Reserved* find_reserved(std::uint8_t bus, std::uint16_t address) const;
  [[nodiscard]] const Part* find_part(std::string_view wanted) const;  // any case
};

// "`0 to 2` and `12`"
[[nodiscard]] std::string list_pins(std::span<const Board::Pins> pins);

// Reads one profile and reports its mistakes. A test checks that the built-in profiles have none.
[[nodiscard]] Board read_board(const BoardText& text, Diagnostics& diagnostics);
// In the order of their places.
[[nodiscard]] std::vector<std::string_view> board_names();
// `place` in board_names().
[[nodiscard]] Board board_at(std::size_t place);
// The board of the preset (CMakePresets.json).
[[nodiscard]] Board default_board();
// Identifies the board in an image: a byte of its name's CRC-32, never 0. A test checks that no two boards share an id.
[[nodiscard]] std::uint8_t board_id(std::string_view name);
// The board at the place that robot.json names; the default board if it names none.
[[nodiscard]] Board board_for(std::optional<std::size_t> named);

}  // namespace robosync::compiler
