// describe_configuration().
#include <algorithm>

#include <fmt/format.h>

#include "compiler/config/boards.hpp"
#include "compiler/config/devices.hpp"
#include "compiler/config/wiring.hpp"
#include "compiler/query/configuration.hpp"
#include "compiler/query/configuration_scan.hpp"

namespace robosync::compiler::query {
namespace {

// The line of `texts` that begins with `name` and a bar, behind that; empty: there is none.
std::string_view line_of(std::string_view texts, std::string_view name) {
  const std::size_t found = texts.find(fmt::format("\n{}|", name));
  if (found == std::string_view::npos) return {};
  texts.remove_prefix(found + name.size() + 2);
  return texts.substr(0, texts.find('\n'));
}

// Each of these is false if it has nothing to say.
bool describe_key(Object object, std::string_view key, Described& result) {
  std::string_view keys = key_texts();
  for (auto skipped = static_cast<int>(object); skipped >= 0; --skipped)
    keys.remove_prefix(keys.find("\n@") + 2);
  keys = keys.substr(0, keys.find("\n@"));
  const std::string_view found = line_of(keys, key);
  if (found.empty()) return false;
  const std::size_t bar = found.find('|');
  std::string_view value = found.substr(0, bar);
  if (value.starts_with('$')) value = line_of(key_texts(), value);
  result.name = key;
  result.about.kind = fmt::format("a key of `{}`", keys.substr(0, keys.find('\n')));
  result.about.text = fmt::format("{}\nValue: {}", found.substr(bar + 1), value);
  return true;
}

bool describe_device(std::string_view name, bool is_sensor, const Robot& robot, Described& result) {
  const Board board = board_for(robot.board);
  const Board::Part* const part = board.find_part(name);
  const Device* const device = find_device(part != nullptr ? part->device : name, is_sensor);
  if (device == nullptr) return false;
  result.name = name;
  result.about.kind = part != nullptr ? "a part of the board " + board.name : "a device";
  std::string& text = result.about.text = device->doc;
  const std::string wiring = part != nullptr ? "" : wiring_of(*device);
  if (!wiring.empty()) text += fmt::format("\nType: {}. Wiring: {}.", device->type, wiring);
  for (const ChannelConfig& channel : device->sensor.channels)
    text += fmt::format("\n`{}`: {}", channel.name.text, describe_channel(channel));
  if (!is_sensor) text += describe_actuator(device->actuator);
  return true;
}

bool describe_board(std::string_view name, Described& result) {
  const auto names = board_names();
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return false;
  const Board board = board_at(static_cast<std::size_t>(found - names.begin()));
  result.name = name;
  result.about.kind = "a board";
  std::vector<std::string> parts;
  for (const Board::Part& part : board.parts)
    parts.push_back(part.name);
  result.about.text = fmt::format(
      "{} bytes for a program, {} instructions in a step.\n"
      "Buses: {} I2C, {} SPI. Lines for sound players: {}.\n"
      "Outputs: {}.\nInputs: {}.\nAnalog inputs: {}.\nParts: {}.",
      board.arena_bytes, board.step_budget, board.i2c_buses, board.spi_buses, board.serial_lines,
      list_pins(board.outputs), list_pins(board.inputs), list_pins(board.analog),
      list_names(parts));
  return true;
}

bool describe_value(Object object, std::string_view key, std::string_view value, const Robot& robot,
                    Described& result) {
  const bool is_sensor = object == Object::sensor;
  if (key == "device" && (is_sensor || object == Object::actuator))
    return describe_device(value, is_sensor, robot, result);
  return key == "board" && object == Object::robot && describe_board(value, result);
}

}  // namespace

Described describe_configuration(const SourceFile& source, FileId file, std::uint32_t offset,
                                 const Robot& robot) {
  const std::string_view text = source.text();
  // A place before a quote belongs to its string, too.
  const bool at_quote = offset < text.size() && text[offset] == '"';
  Scan scan(text, offset + (at_quote ? 1 : 0));
  scan.run();
  const Spot& spot = scan.spot();
  Described result;
  const std::size_t begin = scan.begin(), size = scan.end() - begin;
  if (spot.is_list || !spot.shape.itself || size < 2) return result;
  const std::string_view said = text.substr(begin + 1, size - 2);
  const Object object = *spot.shape.itself;
  result.span = {file, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(begin + size)};
  if (spot.at_key || !describe_value(object, spot.key, said, robot, result))
    describe_key(object, spot.at_key ? said : spot.key, result);
  return result;
}

}  // namespace robosync::compiler::query
