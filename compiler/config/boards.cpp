// Reads board profiles from their JSON.
#include "compiler/config/boards.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "compiler/config/fields.hpp"
#include "compiler/config/json_reader.hpp"
#include "compiler/config/names.hpp"
#include "compiler/config/values.hpp"
#include "vm/image.hpp"

namespace robosync::compiler {
namespace {

std::uint32_t read_number(Fields& fields, std::string_view key, std::string_view what,
                          Diagnostics& diagnostics) {
  const auto* value = fields.require(key, what);
  if (value == nullptr) return 0;
  return static_cast<std::uint32_t>(read_whole(*value, 0, UINT32_MAX, diagnostics).value_or(0));
}

std::uint16_t read_pin(const json::Value& value, Diagnostics& diagnostics) {
  return static_cast<std::uint16_t>(read_whole(value, 0, UINT16_MAX - 1, diagnostics).value_or(0));
}

// [{"pins": [first, last], …}]. The board enforces its own limits on an output. The compiler needs to know whether its pulses may
// start at 0, as the power of a motor does, and which of them are for servos.
std::vector<Board::Pins> read_pins(const json::Value& list, Object object,
                                   Diagnostics& diagnostics) {
  std::vector<Board::Pins> ranges;
  if (!expect_kind(list, json::Kind::array, diagnostics)) return ranges;
  ranges.reserve(list.items.size());
  for (const json::Value& entry : list.items) {
    Fields fields(entry, object, diagnostics);
    const auto* pins = fields.require("pins", "a row of pins");
    if (pins == nullptr || pins->items.size() != 2) continue;
    Board::Pins range{read_pin(pins->items[0], diagnostics), read_pin(pins->items[1], diagnostics)};
    const auto* pulses = fields.find("pulse_us");
    if (pulses != nullptr && pulses->items.size() == 2) {
      const std::uint16_t shortest = read_pin(pulses->items[0], diagnostics);
      range.power = shortest == 0;
      range.pulses = {std::max(shortest, vm::kServoPulses.at_min),
                      std::min(read_pin(pulses->items[1], diagnostics), vm::kServoPulses.at_max)};
    }
    ranges.push_back(range);
  }
  return ranges;
}

bool is_in(const std::vector<Board::Pins>& ranges, std::uint16_t pin) {
  return std::ranges::any_of(
      ranges, [&](const Board::Pins& pins) { return pin >= pins.first && pin <= pins.last; });
}

std::string require_text(Fields& fields, std::string_view key, std::string_view what,
                         Diagnostics& diagnostics) {
  const auto* value = fields.require(key, what);
  return value == nullptr ? std::string() : read_text(*value, diagnostics).value_or("");
}

// {"button_a": {"device": "button", "pin": 5}, …}
std::vector<Board::Part> read_parts(const json::Value& value, Diagnostics& diagnostics) {
  std::vector<Board::Part> parts;
  if (!expect_kind(value, json::Kind::object, diagnostics)) return parts;
  for (const json::Member& member : value.members) {
    constexpr std::string_view kWhat = "a part of a board";
    Fields fields(member.value, Object::part, diagnostics);
    Board::Part part;
    part.name = member.key;
    part.device = require_text(fields, "device", kWhat, diagnostics);
    if (const auto* pin = fields.find("pin")) part.pin = read_pin(*pin, diagnostics);
    if (const auto* bus = fields.find("bus"))
      part.bus = static_cast<std::uint8_t>(read_pin(*bus, diagnostics));
    if (const auto* address = fields.find("address"))
      part.address = read_pin(*address, diagnostics);
    parts.push_back(std::move(part));
  }
  return parts;
}

// [{"bus": 0, "address": "0x50", "for": "the EEPROM"}, …]
std::vector<Board::Reserved> read_reserved(const json::Value& list, Diagnostics& diagnostics) {
  constexpr std::string_view kWhat = "a reserved address";
  std::vector<Board::Reserved> reserved;
  if (!expect_kind(list, json::Kind::array, diagnostics)) return reserved;
  for (const json::Value& entry : list.items) {
    Fields fields(entry, Object::reserved, diagnostics);
    const auto bus = static_cast<std::uint8_t>(read_number(fields, "bus", kWhat, diagnostics));
    const auto address =
        static_cast<std::uint16_t>(read_number(fields, "address", kWhat, diagnostics));
    reserved.push_back({bus, address, require_text(fields, "for", kWhat, diagnostics)});
  }
  return reserved;
}

struct OptionalPins {
  std::string_view key;
  std::vector<Board::Pins> Board::*pins;
};
constexpr OptionalPins kOptionalPins[] = {{"analog", &Board::analog},
                                          {"enables", &Board::enables},
                                          {"panels", &Board::panels},
                                          {"selects", &Board::selects}};

Board::Flash read_flash(const json::Value& value, Diagnostics& diagnostics) {
  constexpr std::string_view kWhat = "flash";
  Fields fields(value, Object::flash, diagnostics);
  Board::Flash flash;
  flash.socket = require_text(fields, "socket", kWhat, diagnostics);
  flash.usb = require_text(fields, "usb", kWhat, diagnostics);
  flash.openocd = require_text(fields, "openocd", kWhat, diagnostics);
  flash.pyocd = require_text(fields, "pyocd", kWhat, diagnostics);
  if (fields.find("dfu") != nullptr) flash.dfu = require_text(fields, "dfu", kWhat, diagnostics);
  if (const auto* drive = fields.require("drive", kWhat)) {
    Fields of_drive(*drive, Object::drive, diagnostics);
    flash.drive = require_text(of_drive, "label", "a drive", diagnostics);
    flash.drive_takes = require_text(of_drive, "takes", "a drive", diagnostics);
  }
  return flash;
}

}  // namespace

std::string Board::Pins::text() const {
  return first == last ? fmt::format("{}", first) : fmt::format("{} to {}", first, last);
}

std::string list_pins(std::span<const Board::Pins> pins) {
  std::vector<std::string> rows;
  for (const Board::Pins& row : pins)
    rows.push_back(row.text());
  return list_names(rows);
}

bool Board::has_output(std::uint16_t pin) const {
  return is_in(outputs, pin);
}

vm::ServoPulses Board::servo_pulses(std::uint16_t pin) const {
  for (const Pins& pins : outputs)
    if (pin >= pins.first && pin <= pins.last) return pins.pulses;
  return vm::kServoPulses;
}

bool Board::gives_power(std::uint16_t pin) const {
  return std::ranges::any_of(outputs, [&](const Pins& pins) {
    return pin >= pins.first && pin <= pins.last && pins.power;
  });
}

bool Board::has_input(std::uint16_t pin) const {
  return is_in(inputs, pin);
}

bool Board::has_echo(std::uint16_t pin) const {
  return is_in(echoes, pin);
}

bool Board::has_analog(std::uint16_t pin) const {
  return is_in(analog, pin);
}

bool Board::has_enable(std::uint16_t pin) const {
  return is_in(enables, pin);
}

std::vector<Board::Pins> Board::all_pins() const {
  std::vector<Pins> all = outputs;
  for (const auto* more : {&inputs, &analog, &enables})
    for (const Pins& pins : *more)
      if (!is_in(all, pins.first) || !is_in(all, pins.last)) all.push_back(pins);
  return all;
}

const Board::Reserved* Board::find_reserved(std::uint8_t bus, std::uint16_t address) const {
  const auto found = std::ranges::find_if(
      reserved, [&](const Reserved& one) { return one.bus == bus && one.address == address; });
  return found == reserved.end() ? nullptr : &*found;
}

const Board::Part* Board::find_part(std::string_view wanted) const {
  const auto found =
      std::ranges::find_if(parts, [&](const Part& part) { return same_name(part.name, wanted); });
  return found == parts.end() ? nullptr : &*found;
}

Board read_board(const BoardText& text, Diagnostics& diagnostics) {
  SourceMap sources;
  const FileId file = sources.add(std::string(text.name), std::string(text.json));
  Board board;
  board.name = text.name;
  const auto tree = json::read(sources, file, diagnostics);
  if (!tree) return board;
  Fields fields(*tree, Object::board, diagnostics);
  board.step_budget = read_number(fields, "step_budget", "a board", diagnostics);
  board.i2c_buses = read_number(fields, "i2c_buses", "a board", diagnostics);
  board.spi_buses = read_number(fields, "spi_buses", "a board", diagnostics);
  board.serial_lines = read_number(fields, "serial_lines", "a board", diagnostics);
  if (const auto* volts = fields.find("volts"))
    board.volts =
        read_quantity(*volts, canonical_unit(vm::Dimension::voltage), diagnostics).value_or(0);
  if (const auto* outputs = fields.require("outputs", "a board"))
    board.outputs = read_pins(*outputs, Object::outputs, diagnostics);
  if (const auto* inputs = fields.require("inputs", "a board"))
    board.inputs = read_pins(*inputs, Object::inputs, diagnostics);
  const auto* echoes = fields.find("echoes");
  board.echoes = echoes != nullptr ? read_pins(*echoes, Object::inputs, diagnostics) : board.inputs;
  for (const auto& [key, pins] : kOptionalPins)
    if (const auto* rows = fields.find(key))
      board.*pins = read_pins(*rows, Object::inputs, diagnostics);
  if (const auto* rows = fields.find("spi_pins"))
    for (const Board::Pins& row : read_pins(*rows, Object::inputs, diagnostics))
      board.spi_pins = row;
  if (const auto* pin = fields.find("player_pin")) board.player_pin = read_pin(*pin, diagnostics);
  if (const auto* reserved = fields.find("reserved"))
    board.reserved = read_reserved(*reserved, diagnostics);
  if (const auto* parts = fields.find("on_board")) board.parts = read_parts(*parts, diagnostics);
  if (const auto* flash = fields.find("flash")) board.flash = read_flash(*flash, diagnostics);
  const auto* arena = fields.require("arena", "a board");
  if (arena == nullptr) return board;
  Fields of_arena(*arena, Object::arena, diagnostics);
  board.arena_begin = read_number(of_arena, "begin", "an arena", diagnostics);
  board.arena_bytes = read_number(of_arena, "bytes", "an arena", diagnostics);
  return board;
}

std::vector<std::string_view> board_names() {
  std::vector<std::string_view> names;
  names.reserve(board_texts().size());
  for (const BoardText& text : board_texts())
    names.push_back(text.name);
  return names;
}

Board board_at(std::size_t place) {
  Diagnostics diagnostics;  // a test checks that built-in profiles have no mistakes
  return read_board(board_texts()[place], diagnostics);
}

Board default_board() {
  const auto names = board_names();
  return board_at(static_cast<std::size_t>(
      std::ranges::find(names, std::string_view(ROBOSYNC_BOARD)) - names.begin()));
}

std::uint8_t board_id(std::string_view name) {
  const auto byte = static_cast<std::uint8_t>(vm::crc32(std::as_bytes(std::span(name))));
  return byte == 0 ? 1 : byte;
}

Board board_for(std::optional<std::size_t> named) {
  return named ? board_at(*named) : default_board();
}

}  // namespace robosync::compiler
