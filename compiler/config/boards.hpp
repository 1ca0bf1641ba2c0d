// The boards that rsc knows: stdlib/boards/*.json, built into the library. What a board has for
// programs decides which of them it takes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"

namespace robosync::compiler {

struct BoardText {  // one profile as built in
  std::string_view name;
  std::string_view json;
};
[[nodiscard]] std::span<const BoardText> board_texts();

struct Board {
  std::string name;
  // By robot.json: of a board that it does not name well, its parts and pins are not missed.
  enum class Named : std::uint8_t { well, not_at_all, wrongly } named = Named::well;
  std::uint32_t arena_begin = 0;  // address of its memory for programs
  std::uint32_t arena_bytes = 0;
  std::uint32_t step_budget = 0;  // M4 instructions of VM code in one step
  struct Pins {
    std::uint16_t first, last;
    bool power = true;  // of outputs: false where pulses are held to those of servos
  };
  std::vector<Pins> outputs;       // pins that a program may drive
  std::vector<Pins> inputs;        // … and read; none is both
  std::vector<Pins> analog;        // whose voltage it may read; one may be an output, too
  std::vector<Pins> enables;       // for the enable inputs of chips
  std::vector<Pins> panels;        // outputs that can tell a panel of lights its picture
  std::uint32_t i2c_buses = 0;     // numbered from 0
  std::uint32_t serial_lines = 0;  // for sound players, from vm::kFirstPlayerLine on
  // How its firmware gets there; nothing: there is no such board but in an emulator.
  struct Flash {
    std::string socket;  // of the cable, in words
    std::string
        usb;  // what its serial line is there, "vendor:product", four hexadecimal digits each
    std::string drive;        // its name as a drive
    std::string drive_takes;  // files with this ending
    std::string openocd;      // the scripts that know it, with spaces between
    std::string pyocd;        // what it is called
  };
  std::optional<Flash> flash;
  struct Part {  // soldered to the board, so nobody has to say how it is wired
    std::string name;
    std::string device;                // its descriptor in stdlib/devices/
    std::optional<std::uint16_t> pin;  // of the lights: none that could be said
    std::uint8_t bus = 0;              // of what is on I2C
    std::uint16_t address = 0;
  };
  std::vector<Part> parts;

  [[nodiscard]] bool has_output(std::uint16_t pin) const;
  [[nodiscard]] bool gives_power(std::uint16_t pin) const;
  [[nodiscard]] bool has_input(std::uint16_t pin) const;
  [[nodiscard]] bool has_analog(std::uint16_t pin) const;
  [[nodiscard]] bool has_enable(std::uint16_t pin) const;
  [[nodiscard]] bool has_panel(std::uint16_t pin) const;
  [[nodiscard]] const Part* find_part(std::string_view wanted) const;  // any case
};

// Reads one profile. Mistakes in it are reported; the tests hold the built-in ones to none.
[[nodiscard]] Board read_board(const BoardText& text, Diagnostics& diagnostics);
// In their order.
[[nodiscard]] std::vector<std::string_view> board_names();
// `place` in board_names().
[[nodiscard]] Board board_at(std::size_t place);
// That of the preset (CMakePresets.json).
[[nodiscard]] Board default_board();
// What stands for its name in an image: a byte of its CRC-32, never 0. The tests see to it that no two boards here share one.
[[nodiscard]] std::uint8_t board_id(std::string_view name);
// The one that robot.json names, by its place; the default where it names none.
[[nodiscard]] Board board_for(std::optional<std::size_t> named);

}  // namespace robosync::compiler
