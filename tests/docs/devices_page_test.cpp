// docs/devices.md: a section for each device of stdlib/devices. The table in it is made of the descriptor, the profiles
// of the boards (stdlib/boards) and the list of the drivers, and compared here; ROBOSYNC_UPDATE_GOLDEN=1 rewrites it.
// What stands around it is written by hand: how it is wired, and an example that rsc checks and runs.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "compiler/config/boards.hpp"
#include "compiler/config/devices.hpp"
#include "compiler/config/entries.hpp"
#include "compiler/config/wiring.hpp"
#include "compiler/units/units.hpp"
#include "tests/docs/pages.hpp"
#include "tests/support/generated.hpp"
#include "vm/drive.hpp"
#include "vm/drivers.hpp"

namespace {

using namespace robosync;
using namespace robosync::compiler;

const std::filesystem::path kDevicesPage =
    std::filesystem::path(ROBOSYNC_SOURCE_DIR) / "docs/devices.md";

// By their numbers, what vm/drivers.def, params.def and vm::Release call them.
struct DriverText {
  std::string_view name, doc;
};
#define SENSOR_DRIVER(name, sample, doc) DriverText{#name, doc},
#define ACTUATOR_DRIVER(name, start, advance, release, ends, output, doc) DriverText{#name, doc},
constexpr DriverText kDriverTexts[] = {
#include "vm/drivers.def"
};
#undef SENSOR_DRIVER
#undef ACTUATOR_DRIVER
constexpr std::string_view kParamTexts[] = {
#define PARAM(name, spelling, doc) spelling,
#include "vm/params.def"
#undef PARAM
};
constexpr std::string_view kReleaseTexts[] = {"hold", "rest", "coast"};

std::string code(std::string_view text) {
  return "`" + std::string(text) + "`";
}

std::string joined(const std::vector<std::string>& parts, std::string_view between = ", ") {
  std::string text;
  for (const std::string& part : parts)
    text += (text.empty() ? "" : std::string(between)) + part;
  return text;
}

std::string row(std::initializer_list<std::string> cells) {
  std::string text = "|";
  for (const std::string& cell : cells)
    text += " " + cell + " |";
  return text + "\n";
}

bool is_virtual(const Device& device) {
  return device.type == "VIRTUAL";
}

vm::DriverId driver_of(const Device& device) {
  return device.is_sensor ? device.sensor.driver : device.actuator.driver;
}

// Lights, speakers, microphones, logos and thermometers of chips are nothing that could be wired.
bool is_only_a_part(const Device& device) {
  return vm::drives_lights(driver_of(device)) || vm::drives_speaker(driver_of(device)) ||
         vm::is_of_board(driver_of(device));
}

// Does the firmware of `board` read or drive it?
bool runs_on(const Device& device, const Board& board) {
  const vm::DriverId driver = driver_of(device);
  if (is_only_a_part(device))
    return std::ranges::any_of(board.parts,
                               [&](const Board::Part& part) { return part.device == device.name; });
  if (vm::is_on_i2c(driver) || vm::drives_screen(driver)) return board.i2c_buses > 0;
  if (vm::is_on_spi(driver)) return board.spi_buses > 0;
  if (vm::drives_player(driver)) return board.serial_lines > 0;
  if (vm::drives_panel(driver)) return !board.panels.empty();
  if (vm::drives_channel(driver)) return board.i2c_buses > 0 && !board.enables.empty();
  if (vm::is_on_pin(driver)) return !board.inputs.empty();
  if (vm::is_by_echo(driver)) return !board.inputs.empty() && !board.outputs.empty();
  if (vm::counts_edges(driver)) return !board.echoes.empty();
  if (vm::is_analog(driver)) return !board.analog.empty();
  return (vm::drives_pin(driver) || vm::drives_wheels(driver)) && !board.outputs.empty();
}

std::string boards_of(const Device& device) {
  if (is_virtual(device)) return "all; it needs no hardware";
  std::vector<std::string> names;
  for (std::size_t i = 0; i < board_names().size(); ++i) {
    const Board board = board_at(i);
    if (!device.has_driver || !runs_on(device, board)) continue;
    std::vector<std::string> parts;
    for (const Board::Part& part : board.parts)
      if (part.device == device.name) parts.push_back(code(part.name));
    names.push_back(code(board.name) +
                    (parts.empty() ? "" : " (on the board: " + joined(parts) + ")"));
  }
  if (vm::is_of_board(driver_of(device))) return joined(names) + "; on the others it is fed";
  if (!names.empty()) return joined(names);
  return device.has_driver
             ? "none yet: its commands take their time, but nothing is sent to a device"
             : "none yet: with `\"type\": \"VIRTUAL\"` you can feed it";
}

std::string unit_of(const Unit* unit) {
  return unit == nullptr || unit->spelling.empty() ? "–" : std::string(unit->spelling);
}

std::string range_of(vm::Value min, vm::Value max, const Unit* unit) {
  if (unit == nullptr) return "–";
  if (min == vm::kValueMin && max == vm::kValueMax) return "any";
  return format_value(min, *unit) + " to " + format_value(max, *unit);
}

std::string length_of(std::uint16_t milliseconds, const std::string& never) {
  return milliseconds == 0 ? never : std::to_string(milliseconds) + " ms";
}

std::string addresses_of(const Device& device) {
  std::vector<std::string> rows;
  for (const Device::Addresses& one : device.addresses)
    rows.push_back(one.first == one.last ? fmt::format("{:#04x}", one.first)
                                         : fmt::format("{:#04x} to {:#04x}", one.first, one.last));
  return joined(rows);
}

// What has a wire that brings a voltage to the board.
std::string volts_row(const Device& device) {
  const bool in = device.is_sensor ? !is_only_a_part(device) : device.type == "I2C";
  if (is_virtual(device) || !in) return "";
  return row({"`volts`", "the highest voltage that it puts on a pin of the board",
              device.volts == 0
                  ? "that of the board"
                  : format_value(device.volts, canonical_unit(vm::Dimension::voltage))});
}

std::string wiring_keys(const Device& device) {
  const auto types = wiring_types();
  const auto type = std::ranges::find(types, device.type, &WiringType::name);
  REQUIRE(type != types.end());
  if (is_virtual(device)) return "";
  if (is_only_a_part(device))
    return row({"`device`", "the name of the part, which is already wired", "required"});
  std::string rows;
  if (vm::drives_channel(driver_of(device)))
    return row({"`address`",
                fmt::format("{:#04x} to {:#04x}, and not {:#04x}", vm::kFirstChipAddress,
                            vm::kLastAddress, vm::kAllChipsAddress),
                fmt::format("{:#04x}", vm::kFirstChipAddress)}) +
           row({"`bus`", "a bus of the board", "0"}) +
           row({"`channel`", "0 to " + std::to_string(vm::kChipChannels - 1), "required"}) +
           row({"`enable`",
                "the board's pin that is wired to OE, the same for all servos of the chip",
                "required"});
  const bool screen = vm::drives_screen(driver_of(device));
  if (type->address)
    rows +=
        row({"`address`",
             device.addresses.empty()
                 ? fmt::format("{:#04x} to {:#04x}",
                               screen ? vm::kFirstDisplayAddress : vm::kFirstAddress,
                               screen ? vm::kLastDisplayAddress : vm::kLastAddress)
                 : addresses_of(device),
             screen                         ? fmt::format("{:#04x}", vm::kFirstDisplayAddress)
             : device.addresses.size() == 1 ? fmt::format("{:#04x}", device.addresses.front().first)
                                            : "required"});
  if (vm::drives_player(driver_of(device)))
    return row({"`bus`", "a serial line of the board", "1"});
  if (type->bus) rows += row({"`bus`", "a bus of the board", "0"});
  if (vm::is_by_echo(driver_of(device)))
    return row({"`trigger`", "an output of the board", "required"}) +
           row({"`echo`", "an input of the board", "required"});
  if (vm::counts_edges(driver_of(device)))
    return row({"`pin`", "an input of the board whose edges it counts; or …", "required"}) +
           row({"`pins`",
                "two inputs, A and B: the edges of A are counted, and B gives the direction",
                "–"}) +
           row({"`pulses_per_turn`", "of the wheel, 1 to 10000", "required"}) +
           row({"`wheel`", "its diameter, 0.5cm to 50cm", "required"});
  if (vm::is_analog(driver_of(device)))
    return row({"`pin`", "an analog input of the board", "required"});
  if (vm::drives_panel(driver_of(device)))
    return row({"`pin`", "an output of the board that can drive a panel or strip", "required"});
  if (vm::drives_wheels(driver_of(device)))
    return row({"`left`", "two outputs of the board: the left motor forward, backward",
                "required"}) +
           row({"`right`", "two outputs of the board: the right motor forward, backward",
                "required"}) +
           row({"`speed`", "of the robot with full power, above 0cm/s", "required"}) +
           row({"`track`",
                "the distance between the wheels, above 0cm and at most " +
                    format_value(vm::kMostTrack, *device.actuator.to_unit),
                "required"}) +
           row({"`trim`",
                fmt::format("`left`, `right`: each {}% to {}% of the power", kLeastTrim,
                            vm::kFullTrim),
                "100% for both"}) +
           row({"`encoders`", "the names of two encoders: of the left wheel, of the right wheel",
                "none: it goes by timing"}) +
           row({"`simulated_difference`",
                fmt::format("with `encoders`: how much slower the right wheel is where the wheels "
                            "are virtual, -{0}% to {0}%",
                            int{vm::kMostDifference}),
                fmt::format("{}%", int{kUsualDifference})});
  if (vm::is_on_spi(driver_of(device)))
    rows += row({"`pin`", "the board's pin that is wired to the part's select input", "required"});
  else if (vm::has_two_pins(driver_of(device)))
    rows += row({"`pins`", "two outputs of the board: forward, backward", "required"});
  else if (type->pin)
    rows += row({"`pin`", device.is_sensor ? "an input of the board" : "an output of the board",
                 "required"});
  if (device.is_sensor && device.type == "GPIO")
    rows += row({"`active`", "`low`, `high`: the active level", "`low`"});
  if (device.has_registers())
    rows += row({"`register`", "0 to " + std::to_string(device.inputs - 1), "0"});
  if (driver_of(device) == vm::DriverId::spi_register)
    rows +=
        row({"`format`", "`uint16`, `int16`, `uint16le`, `int16le`, `uint8`, `int8`", "`uint16`"});
  return rows;
}

std::string channel_table(const Device& device) {
  std::string table =
      "\n| channel | input | unit | range | read every | unknown after |\n"
      "|---|---|---|---|---|---|\n";
  for (const ChannelConfig& channel : device.sensor.channels) {
    const bool words = !channel.labels.empty();
    table += row({code(channel.name.text), std::to_string(channel.input),
                  words ? "–" : unit_of(channel.unit),
                  words ? "the words " + joined(channel.labels)
                        : range_of(channel.min, channel.max, channel.unit),
                  is_virtual(device) ? "when it is fed" : length_of(channel.period_ms, "–"),
                  length_of(channel.stale_ms, "never")});
  }
  return table;
}

std::string verb_row(const ActuatorConfig& actuator, const VerbConfig& verb) {
  std::vector<std::string> takes;
  for (unsigned p = 0; p < static_cast<unsigned>(vm::Param::count_); ++p)
    if (verb.has(static_cast<vm::Param>(p)) && !kParamTexts[p].empty()) {
      const auto param = static_cast<vm::Param>(p);
      const bool amount =
          param == vm::Param::to || param == vm::Param::by || param == vm::Param::at;
      const std::string unit = amount ? unit_of(&param_unit(actuator, param, &verb)) : "–";
      takes.push_back(code(kParamTexts[p]) + (unit == "–" ? "" : " (" + unit + ")"));
    }
  if (verb.texts == Texts::any) takes.emplace_back("a text");
  if (verb.texts == Texts::listed) takes.emplace_back("one of its `sounds`");
  const std::string words = joined(actuator.words_of(verb));
  return row({code(verb.name), takes.empty() ? "–" : joined(takes), words.empty() ? "–" : words});
}

std::string verb_table(const Device& device) {
  std::string table = "\n| verb | takes | words |\n|---|---|---|\n";
  for (const VerbConfig& verb : device.actuator.verbs)
    table += verb_row(device.actuator, verb);
  return table;
}

std::string releases(bool hold) {
  std::vector<std::string> allowed;
  for (const std::string_view name : kReleaseTexts)
    if (hold || name != kReleaseTexts[static_cast<std::size_t>(vm::Release::hold)])
      allowed.push_back(code(name));
  return joined(allowed);
}

std::string actuator_keys(const Device& device) {
  const ActuatorConfig& actuator = device.actuator;
  std::string rows;
  if (actuator.to_unit != nullptr && !actuator.shows_numbers()) {
    const std::string range = range_of(actuator.min, actuator.max, actuator.to_unit);
    const std::string widest = range_of(actuator.lowest, actuator.highest, actuator.to_unit);
    rows += row({"`range`", "of `TO`, within " + widest, range});
  }
  if (vm::is_servo(actuator.driver)) {
    const vm::ServoPulses usual;
    rows +=
        row({"`pulse`",
             fmt::format(
                 "[its pulses](configuration.md#pulses-of-a-servo) at the ends of `range`, each "
                 "from {} to {} us, or `ms`; with the longer one first it turns the other way",
                 usual.at_min, usual.at_max),
             fmt::format("`[\"{}us\", \"{}us\"]`", usual.at_min, usual.at_max)});
  }
  if (actuator.at_unit != nullptr) {
    const std::string above = "above " + format_value(0, *actuator.at_unit);
    rows += row({"`speeds`", "words for `AT`, each " + above, "the words above"});
    const std::string of = vm::gives_power(actuator.driver) ? "`AT` and `TO`, " : "`AT`, ";
    rows += row({"`limits`: `SPEED`", "the maximum of " + of + above, "none"});
    if (actuator.moves_at_a_speed())
      rows += row({"`limits`: `ACCELERATION`",
                   format_acceleration(1, *actuator.at_unit) + " to " +
                       format_acceleration(UINT16_MAX, *actuator.at_unit),
                   "none"});
  }
  if (vm::drives_panel(actuator.driver)) {
    std::vector<std::string> colors;
    for (const std::string_view color : panel_colors())
      colors.push_back(code(color));
    if (vm::is_strip(actuator.driver)) {
      rows += row({"`lights`", fmt::format("1 to {}: how many", vm::kMostPanelLights), "required"});
    } else {
      rows += row({"`size`", "`5x5`, `8x8`", "`5x5`"});
      rows += row({"`zigzag`", "true: every second row is wired from right to left", "false"});
      rows += row({"`color`", joined(colors), colors.front()});
    }
    rows += row({"`brightness`", fmt::format("1 to {}, in percent", kMostPanelPercent),
                 std::to_string(kUsualPanelPercent)});
  }
  if (device.has_sounds) rows += row({"`sounds`", "files, in track order", "none"});
  const auto release = [](vm::Release how) {
    return code(kReleaseTexts[static_cast<std::size_t>(how)]);
  };
  rows += row({"`on_release`", releases(true), release(actuator.on_release)});
  return rows + row({"`safe`", releases(!vm::drives_on(actuator.driver)), release(actuator.safe)});
}

std::string section_of(const Device& device) {
  const DriverText& driver = kDriverTexts[static_cast<std::size_t>(driver_of(device))];
  const std::string kind = device.is_sensor ? "sensor" : "actuator";
  std::string text = "| | |\n|---|---|\n";
  text += row({"kind", kind + ", `\"type\": \"" + device.type + "\"`" +
                           (device.is_default ? "; the default without `device`" : "")});
  text += row({"driver", device.has_driver ? code(driver.name) + ": " + std::string(driver.doc)
                                           : "none yet"});
  text += row({"boards", boards_of(device)});
  const std::uint16_t shortest = device.is_sensor ? device.shortest_period_ms() : 0;
  if (shortest != 0)
    text += row({"highest rate",
                 fmt::format("{}Hz: a new reading takes {} ms", 1000 / shortest, shortest)});
  text += device.is_sensor ? channel_table(device) : verb_table(device);
  std::string keys = wiring_keys(device) + volts_row(device);
  if (device.is_sensor)
    keys += row({"`channels`",
                 "changes to the channels above: [keys of a channel](configuration.md#sensors)",
                 "the channels above"});
  else
    keys += actuator_keys(device);
  return text + "\n| key | value | default |\n|---|---|---|\n" + keys;
}

std::string overview() {
  std::string table = "| device | description | type | boards |\n|---|---|---|---|\n";
  for (const DeviceText& text : device_texts()) {
    Diagnostics diagnostics;
    const Device device = read_device(text, diagnostics);
    const std::string doc = nlohmann::json::parse(text.json).at("doc");
    const std::string name(text.name);
    table += row({"[" + code(name) + "](#" + name + ")", doc, device.type, boards_of(device)});
  }
  return table;
}

std::string pins(std::span<const Board::Pins> ranges) {
  std::string text;
  for (const Board::Pins& range : ranges) {
    text += (text.empty() ? "" : ", ") + std::to_string(range.first);
    if (range.last != range.first) text += " to " + std::to_string(range.last);
  }
  return text;
}

std::string pins_for_encoders() {
  std::string table = "| board | counted | direction |\n|---|---|---|\n";
  for (std::size_t i = 0; i < board_names().size(); ++i) {
    const Board board = board_at(i);
    table += row({code(board.name), pins(board.echoes), pins(board.inputs)});
  }
  return table;
}

// A trigger is a pulse shorter than those of a servo.
std::string pins_for_echoes() {
  std::string table = "| board | trigger | echo |\n|---|---|---|\n";
  for (std::size_t i = 0; i < board_names().size(); ++i) {
    const Board board = board_at(i);
    std::vector<Board::Pins> triggers;
    std::ranges::copy_if(board.outputs, std::back_inserter(triggers), &Board::Pins::power);
    table += row({code(board.name), pins(triggers), pins(board.echoes)});
  }
  return table;
}

std::vector<std::string> sections(const std::string& page) {
  std::vector<std::string> found;
  for (auto at = page.find("\n## "); at != std::string::npos;) {
    const auto next = page.find("\n## ", at + 1);
    found.push_back(page.substr(at + 4, next == std::string::npos ? next : next - at - 4));
    at = next;
  }
  return found;
}

std::string title_of(const std::string& section) {
  return section.substr(0, section.find('\n'));
}

// By its name, by that of a part of a board, or as what is meant without `device`.
bool means(const nlohmann::json& entry, const Device& device, const Board& board) {
  const auto named = entry.find("device");
  if (named == entry.end()) return device.is_default && entry.at("type") == device.type;
  const Board::Part* const part = board.find_part(named->get<std::string>());
  return (part != nullptr ? part->device : named->get<std::string>()) == device.name;
}

void check_example(const std::string& section, const Device& device) {
  const auto robots = test::blocks_in(section, "json");
  const auto programs = test::blocks_in(section, "rsl");
  REQUIRE(robots.size() == 1);
  REQUIRE(programs.size() == 1);
  const auto robot = nlohmann::json::parse(robots[0]);
  const auto names = board_names();
  const auto named = std::ranges::find(names, robot.value("board", default_board().name));
  REQUIRE(named != names.end());
  const Board board = board_at(static_cast<std::size_t>(named - names.begin()));
  const auto& entries = robot.at(device.is_sensor ? "sensors" : "actuators");
  CHECK(std::ranges::any_of(entries, [&](const auto& one) { return means(one, device, board); }));
  test::check_program(programs[0], robots[0]);
}

}  // namespace

TEST_CASE("docs/devices.md says of each device what its descriptor and the boards do") {
  testing::expect_generated(kDevicesPage, "devices", overview());
  testing::expect_generated(kDevicesPage, "pins of hc-sr04", pins_for_echoes());
  testing::expect_generated(kDevicesPage, "pins of encoder", pins_for_encoders());
  for (const DeviceText& text : device_texts()) {
    INFO(text.name);
    Diagnostics diagnostics;
    testing::expect_generated(kDevicesPage, std::string(text.name),
                              section_of(read_device(text, diagnostics)));
  }
}

TEST_CASE(
    "docs/devices.md has a section for each device, with an example that works, and none else") {
  const auto found = sections(testing::read_file(kDevicesPage));
  std::vector<std::string> titles;
  std::ranges::transform(found, std::back_inserter(titles), title_of);
  std::vector<std::string> names;
  for (const DeviceText& text : device_texts())
    names.emplace_back(text.name);
  REQUIRE(titles == names);
  for (std::size_t i = 0; i < found.size(); ++i) {
    INFO(names[i]);
    Diagnostics diagnostics;
    CHECK(found[i].find("<!-- generated: " + names[i] + " -->") != std::string::npos);
    check_example(found[i], read_device(device_texts()[i], diagnostics));
  }
}
