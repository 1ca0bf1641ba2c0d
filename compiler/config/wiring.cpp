#include "compiler/config/wiring.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/config/devices.hpp"
#include "compiler/config/values.hpp"
#include "compiler/diagnostics/nearest.hpp"
#include "vm/drivers.hpp"

namespace robosync::compiler {

// Pins for a use that not every board has.
struct SpecialPins {
  const char *board_has_no, *pin_is_not, *those, *boards;
  bool (*have)(const Board&);
};

namespace {

constexpr std::array<WiringType, 7> kTypes = {{
    // name      sensors actuators  bus    address pin
    {"I2C", true, true, true, true, false},
    {"SPI", true, true, true, false, true},
    {"GPIO", true, true, false, false, true},
    {"PWM", false, true, false, false, true},
    {"ADC", true, false, false, false, true},
    {"UART", true, true, true, false, false},
    {"VIRTUAL", true, true, true, true, true},  // keys of the real wiring may stay
}};

constexpr std::array<std::string_view, static_cast<std::size_t>(vm::ActiveLevel::count_)> kLevels =
    {"low", "high"};

constexpr std::array<std::string_view, static_cast<std::size_t>(vm::Release::count_)> kReleases = {
    "hold", "rest", "coast"};

// Suggests two pins that the board has.
std::string help_for_echo(const Board& board) {
  const std::string says = "an output and an input, named as on the part";
  const auto output = std::ranges::find(board.outputs, true, &Board::Pins::power);
  if (output == board.outputs.end() || board.echoes.empty())
    return "write `trigger` and `echo`: " + says;
  return "write `\"trigger\": " + std::to_string(output->first) +
         ", \"echo\": " + std::to_string(board.echoes.front().first) + "`: " + says;
}

// The boards with a part of this device, and the names of the parts.
std::string boards_with(std::string_view device) {
  std::vector<std::string> boards;
  for (std::size_t i = 0; i < board_names().size(); ++i)
    for (const Board::Part& part : board_at(i).parts)
      if (same_name(part.device, device))
        boards.push_back(std::string(board_names()[i]) + "` as `\"device\": \"" + part.name + "\"");
  return list_names(boards, "and");
}

// The boards for which `have` is true.
std::string boards_that(bool (*have)(const Board&)) {
  std::vector<std::string> boards;
  for (std::size_t i = 0; i < board_names().size(); ++i)
    if (have(board_at(i))) boards.emplace_back(board_names()[i]);
  return list_names(boards, "and");
}

constexpr SpecialPins kAnalog = {
    "analog inputs", "an analog input", "its analog inputs are the pins ",
    "boards that have some: ", [](const Board& board) { return !board.analog.empty(); }};
constexpr SpecialPins kPanel = {
    "pin for a panel or strip of lights", "for a panel or strip of lights", "pins that are: ",
    "boards that have one: ", [](const Board& board) { return !board.panels.empty(); }};
constexpr SpecialPins kEnable = {
    "pin for the enable input of a chip", "for the enable input of a chip",
    "only a pin that is high from the start is: ", "boards that have one: ",
    [](const Board& board) { return !board.enables.empty(); }};
constexpr SpecialPins kSelect = {
    "pin for the select input of a part", "for the select input of a part",
    "pins that are: ", kEnable.boards, [](const Board& board) { return !board.selects.empty(); }};

}  // namespace

std::span<const WiringType> wiring_types() {
  return kTypes;
}

const WiringType* read_type(Fields& fields, bool is_sensor, Diagnostics& diagnostics) {
  const auto* value = fields.require("type", is_sensor ? "a sensor" : "an actuator");
  if (value == nullptr) return nullptr;
  std::vector<std::string_view> names;
  for (const WiringType& type : kTypes)
    if (is_sensor ? type.for_sensors : type.for_actuators) names.push_back(type.name);
  const bool known = std::ranges::any_of(
      names, [&](std::string_view name) { return same_name(name, value->text); });
  if (!known && value->kind == json::Kind::string &&
      find_device(value->text, is_sensor) != nullptr) {
    diagnostics
        .report(Code::E0204, "this must say how it is wired, but `" + value->text + "` is a device")
        .label(value->span)
        .helps("write `\"device\": \"" + value->text + "\"`; it implies the type");
    return nullptr;
  }
  const auto choice = read_choice(*value, names, diagnostics);
  if (!choice) return nullptr;
  for (const WiringType& type : kTypes)
    if (type.name == names[*choice]) return &type;
  return nullptr;
}

void WiringReader::report_foreign(const Fields& fields, const WiringType& type) {
  const auto check = [&](std::string_view key, bool allowed) {
    const auto* value = fields.find(key);
    if (value == nullptr || allowed) return;
    diagnostics_
        .report(Code::E0205,
                "a device of type " + std::string(type.name) + " has no `" + std::string(key) + "`")
        .label(value->span);
  };
  check("bus", type.bus);
  check("address", type.address);
  check("pin", type.pin);
  check("pins", type.pin);
  check("active", type.name == "GPIO");
  check("trigger", false);
  check("echo", false);
  check("channel", false);
  check("enable", false);
}

std::uint16_t WiringReader::read_pin(const json::Value& value, std::uint16_t last) {
  const auto pin = read_whole(value, 0, last, diagnostics_);
  if (!pin) return 0;
  const auto number = static_cast<std::uint16_t>(*pin);
  take_pin(number, value.span);
  return number;
}

// 3; or, for two pins: [3, 4]. The image has one byte for the second one.
void WiringReader::read_pins(Fields& fields, bool two, const std::string& what, Wiring& wiring) {
  const auto report = [&](const json::Value& wrong) {
    diagnostics_.report(Code::E0205, what + (two ? " has two pins" : " has one pin"))
        .label(wrong.span)
        .helps(two ? "write `\"pins\": [3, 4]`: the first drives it forward, the second backward"
                   : "write `\"pin\": 3`");
  };
  if (const auto* wrong = fields.find(two ? "pin" : "pins")) return report(*wrong);
  const auto* value = fields.require(two ? "pins" : "pin", what);
  if (value == nullptr) return;
  if (!two) {
    wiring.place = read_pin(*value);
  } else if (value->kind != json::Kind::array || value->items.size() != 2) {
    report(*value);
  } else {
    wiring.place = read_pin(value->items[0]);
    wiring.bus = static_cast<std::uint8_t>(read_pin(value->items[1], UINT8_MAX));
  }
}

std::optional<std::array<std::uint8_t, 2>> WiringReader::read_motor(const json::Value& value,
                                                                    std::string_view side) {
  if (value.kind != json::Kind::array || value.items.size() != 2) {
    diagnostics_.report(Code::E0205, "the " + std::string(side) + " motor has two pins")
        .label(value.span)
        .helps("write `\"" + std::string(side) +
               "\": [4, 5]`: the first drives it forward, the second backward");
    return std::nullopt;
  }
  std::array<std::uint8_t, 2> pins{};
  for (std::size_t i = 0; i < pins.size(); ++i) {
    pins.at(i) = static_cast<std::uint8_t>(read_pin(value.items[i], UINT8_MAX));
    check_output_pin(value.items[i], pins.at(i), true);
  }
  return pins;
}

void WiringReader::take_drive(const Fields& fields, const WiringType& type) {
  report_foreign(fields, type);
  const Span span = fields.find("device")->span;
  if (drive_) {
    diagnostics_.report(Code::E0207, "a robot can have only one differential drive")
        .label(span)
        .label(*drive_, "the first one", false);
  } else {
    drive_ = span;
  }
}

void WiringReader::take_pin(std::uint16_t pin, Span span) {
  const auto [first, added] = pins_.emplace(pin, span);
  if (!added) pins_twice_.push_back({pin, span, first->second});
}

void WiringReader::report_pins_used_twice() {
  for (const auto& [pin, span, first] : pins_twice_) {
    Diagnostic& report =
        diagnostics_.report(Code::E0207, "pin " + std::to_string(pin) + " is used twice")
            .label(span)
            .label(first, "first used here", false);
    if (const Board::Pins& bus = board_.spi_pins; on_spi_ && pin >= bus.first && pin <= bus.last)
      report.helps("the SPI bus of this board has the pins " + bus.text());
  }
}

// The default is a contact to GND on a pin with a pull-up, the most common wiring.
std::uint8_t WiringReader::read_active(const Fields& fields) {
  const auto* active = fields.find("active");
  if (active == nullptr) return static_cast<std::uint8_t>(vm::ActiveLevel::low);
  return static_cast<std::uint8_t>(read_choice(*active, kLevels, diagnostics_).value_or(0));
}

// Parts of a board with a contact close to ground, against a pull-up.
Wiring WiringReader::read_part(const Fields& fields, const Board::Part& part) {
  for (const char* key : {"bus", "address", "pin", "active", "volts"})
    if (const auto* value = fields.find(key))
      diagnostics_
          .report(Code::E0205, "the `" + part.name + "` of the board " + board_.name +
                                   " is already wired: it takes no `" + key + "`")
          .label(value->span);
  const Span span = fields.find("device")->span;
  part.pin ? take_pin(*part.pin, span) : take_part(part, span);
  if (part.address != 0) return {part.bus, part.address};
  return {static_cast<std::uint8_t>(vm::ActiveLevel::low), part.pin.value_or(0)};
}

void WiringReader::take_part(const Board::Part& part, Span span) {
  const auto [first, added] = parts_.emplace(&part, span);
  if (added) return;
  diagnostics_.report(Code::E0207, "the part `" + part.name + "` of the board is used twice")
      .label(span)
      .label(first->second, "first used here", false);
}

void WiringReader::check_part(const Fields& fields, const Board::Part* part) {
  const auto* device = fields.find("device");
  if (part != nullptr || device == nullptr) return;
  diagnostics_
      .report(Code::E0205, "`" + device->text + "` is a part of a board, so it cannot be wired")
      .label(device->span)
      .helps("boards that have one: " + boards_with(device->text));
}

void WiringReader::check_converter(const Fields& fields, bool microphone) {
  const auto* device = fields.find("device");
  const Span span = (device != nullptr ? device : fields.find("type"))->span;
  std::optional<Span>& mine = microphone ? microphone_ : analog_;
  const std::optional<Span>& other = microphone ? analog_ : microphone_;
  const bool is_first = !mine;
  if (is_first) mine = span;
  if (!is_first || !other) return;
  diagnostics_
      .report(Code::E0207,
              "the microphone and the analog inputs use the same converter: a robot can have "
              "either, not both")
      .label(span)
      .label(*other, microphone ? "an analog input" : "the microphone", false)
      .helps("with `\"type\": \"VIRTUAL\"` one of them can be fed");
}

namespace {

// An entry without an address has the one that its device is delivered with.
const json::Value& assume_address(Fields& fields, std::uint16_t usual) {
  return fields.assume("address", fmt::format("0x{:02x}", usual), fields.find("device")->span);
}

}  // namespace

// ---- servos on a chip

namespace {

std::string name_of(const ServoChip& chip) {
  return fmt::format("the chip at 0x{:02x} on bus {}", chip.address, chip.bus);
}

}  // namespace

void WiringReader::refuse_pins(const Fields& fields) {
  for (const char* key : {"pin", "pins"})
    if (const auto* wrong = fields.find(key))
      diagnostics_.report(Code::E0205, "a servo on a chip has no `" + std::string(key) + "`")
          .label(wrong->span)
          .helps(
              "write `\"channel\"`, the chip's output, and `\"enable\"`, the pin of the "
              "board that is connected to the chip's OE");
}

// Requires the enable input: without it, only the bus could stop the servos.
ChipWiring WiringReader::read_chip(Fields& fields) {
  ChipWiring wiring;
  refuse_pins(fields);
  const std::string what = "a " + fields.find("device")->text;
  ServoChip chip;
  if (const auto* bus = fields.find("bus"))
    chip.bus = static_cast<std::uint8_t>(read_whole(*bus, 0, UINT8_MAX, diagnostics_).value_or(0));
  const json::Value& address = assume_address(fields, vm::kFirstChipAddress);
  const auto* channel = fields.require("channel", what);
  const auto* enable = fields.require("enable", what);
  check_bus(fields, {chip.bus, 0});
  if (channel == nullptr || enable == nullptr) return wiring;
  const auto place = read_address(address, vm::kFirstChipAddress, vm::kLastAddress, diagnostics_);
  const auto output = read_whole(*channel, 0, vm::kChipChannels - 1, diagnostics_);
  const auto pin = read_whole(*enable, 0, UINT8_MAX, diagnostics_);
  if (!place || !output || !pin) return wiring;
  if (*place == vm::kAllChipsAddress) {
    diagnostics_.report(Code::E0205, "no PCA9685 can have this address: all of them answer to it")
        .label(address.span);
    return wiring;
  }
  chip.address = static_cast<std::uint16_t>(*place);
  check_address(fields, {chip.bus, chip.address});
  chip.enable = static_cast<std::uint8_t>(*pin);
  wiring.channel = static_cast<std::uint16_t>(*output);
  take_chip(chip, address, *enable);
  if (on_buses_[{chip.bus, chip.address}].chip != chip) return wiring;
  wiring.chip = chip;
  take_channel(chip, wiring.channel, channel->span);
  return wiring;
}

void WiringReader::take_channel(const ServoChip& chip, std::uint16_t channel, Span span) {
  const auto [first, added] = on_buses_[{chip.bus, chip.address}].channels.emplace(channel, span);
  if (added) return;
  diagnostics_
      .report(Code::E0207,
              "channel " + std::to_string(channel) + " of " + name_of(chip) + " is used twice")
      .label(span)
      .label(first->second, "first used here", false);
}

// Each chip needs its own address and its own enable pin: two chips on one pin could not be stopped separately.
void WiringReader::take_chip(const ServoChip& chip, const json::Value& address,
                             const json::Value& enable) {
  const auto [entry, added] = on_buses_.emplace(std::pair(chip.bus, chip.address),
                                                OnBus{.span = address.span, .chip = chip});
  OnBus& known = entry->second;
  if (added) {
    known.enable = enable.span;
    take_pin(chip.enable, enable.span);
    return check_special(enable, chip.enable, board_.enables, kEnable);
  }
  if (!known.chip) return report_taken(known, {chip.bus, chip.address}, address.span);
  if (known.chip->enable == chip.enable) return;
  if (board_.has_enable(known.chip->enable)) {
    diagnostics_
        .report(Code::E0205, name_of(chip) + " has its enable input on pin " +
                                 std::to_string(known.chip->enable))
        .label(enable.span)
        .label(known.enable, "set here", false);
    return;
  }
  // The enable pin in the first entry was wrong, which has been reported. It says nothing about this one.
  known.chip = chip;
  known.enable = enable.span;
  take_pin(chip.enable, enable.span);
  check_special(enable, chip.enable, board_.enables, kEnable);
}

void WiringReader::report_taken(const OnBus& known, const Wiring& place, Span span) {
  diagnostics_
      .report(Code::E0207,
              fmt::format("address 0x{:02x} on bus {} is used twice", place.place, place.bus))
      .label(span)
      .label(known.span, "first used here", false);
}

void WiringReader::report_same(const OnBus& known, const Wiring& place, Span span) {
  diagnostics_
      .report(Code::W0225,
              fmt::format("two sensors are one part: address 0x{:02x} on bus {} is used twice",
                          place.place, place.bus))
      .label(span)
      .label(known.span, "first used here", false)
      .helps("if the robot has two of these parts, give one of them another address");
}

// All sensors have been read before, so their addresses are known.
Wiring WiringReader::read_display(Fields& fields, const WiringType& type) {
  report_foreign(fields, type);
  Wiring wiring;
  if (const auto* bus = fields.find("bus"))
    wiring.bus =
        static_cast<std::uint8_t>(read_whole(*bus, 0, UINT8_MAX, diagnostics_).value_or(0));
  check_bus(fields, wiring);
  const json::Value& address = assume_address(fields, vm::kFirstDisplayAddress);
  const auto place =
      read_address(address, vm::kFirstDisplayAddress, vm::kLastDisplayAddress, diagnostics_);
  if (!place) return wiring;
  wiring.place = static_cast<std::uint16_t>(*place);
  const auto [entry, added] =
      on_buses_.emplace(std::pair(wiring.bus, wiring.place), OnBus{.span = address.span});
  if (!added) report_taken(entry->second, wiring, address.span);
  return wiring;
}

void WiringReader::check_safe(const ServoChip& chip, vm::Release safe, Span span) {
  OnBus& known = on_buses_[{chip.bus, chip.address}];
  if (!known.safe) {
    known.safe = safe;
    known.safe_span = span;
  } else if (known.safe != safe) {
    diagnostics_
        .report(Code::E0205, "the servos of " + name_of(chip) + " have different safe states")
        .label(span, "`" + std::string(kReleases.at(static_cast<std::size_t>(safe))) + "`")
        .label(known.safe_span,
               "`" + std::string(kReleases.at(static_cast<std::size_t>(*known.safe))) + "`", false)
        .helps("its single enable input stops all of them: give each the same `safe`");
  }
}

// The image has one byte for the trigger pin.
Wiring WiringReader::read_echo(Fields& fields, const std::string& what) {
  for (const char* key : {"pin", "bus", "address", "active"})
    if (const auto* wrong = fields.find(key))
      diagnostics_.report(Code::E0205, what + " has no `" + key + "`")
          .label(wrong->span)
          .helps(help_for_echo(board_));
  Wiring wiring;
  const bool lacks_one = fields.find("trigger") == nullptr || fields.find("echo") == nullptr;
  if (lacks_one && fields.find("pin") != nullptr) return wiring;
  const auto* trigger = fields.require("trigger", what);
  const auto* echo = fields.require("echo", what);
  if (trigger != nullptr) wiring.bus = static_cast<std::uint8_t>(read_pin(*trigger, UINT8_MAX));
  if (echo != nullptr) wiring.place = read_pin(*echo);
  return wiring;
}

namespace {

// The chip of a sensor; nullptr for the generic device of which robot.json names a register.
const Device* chip_of(const Fields& fields, const Board::Part* part) {
  const auto* said = fields.find("device");
  if (part == nullptr && said == nullptr) return nullptr;
  const Device* const device = find_device(part != nullptr ? part->device : said->text, true);
  return device != nullptr && device->has_registers() ? nullptr : device;
}

}  // namespace

Wiring WiringReader::read_sensor(Fields& fields, const WiringType& type, const Board::Part* part,
                                 vm::DriverId driver) {
  if (type.name != "VIRTUAL" && vm::is_by_echo(driver))
    return read_echo(fields, "the device `" + fields.find("device")->text + "`");
  if (type.name != "VIRTUAL" && vm::counts_edges(driver)) return read_encoder(fields, type);
  if (part == nullptr && vm::is_of_board(driver)) return {};  // check_part() reports it
  Wiring wiring = read(fields, type, part, false, "a sensor of type " + std::string(type.name));
  if (part == nullptr && type.name == "GPIO") wiring.bus = read_active(fields);
  if (type.name == "I2C") take_address(fields, wiring, part, vm::measures_when_told(driver));
  return wiring;
}

Wiring WiringReader::read_actuator(Fields& fields, const WiringType& type, const Board::Part* part,
                                   vm::DriverId driver) {
  const bool two_pins = vm::has_two_pins(driver);
  const auto* device = fields.find("device");
  const std::string what = two_pins && device != nullptr
                               ? "a " + device->text
                               : "an actuator of type " + std::string(type.name);
  const Wiring wiring = read(fields, type, part, two_pins, what);
  if (type.name == "I2C") take_address(fields, wiring, part, false);
  return wiring;
}

// Several sensors may read registers of the same chip. But a chip that measures on demand must have one sensor only: two would
// take each other's results. Two different chips would both answer.
void WiringReader::take_address(const Fields& fields, const Wiring& place, const Board::Part* part,
                                bool alone) {
  const auto* said = fields.find(part != nullptr ? "device" : "address");
  Diagnostics reported;  // they were reported before
  if (said == nullptr || (part == nullptr && read_whole(*said, vm::kFirstAddress, vm::kLastAddress,
                                                        reported) != place.place))
    return;
  const OnBus taken{.span = said->span, .alone = alone, .device = chip_of(fields, part)};
  if (taken.device != nullptr && !taken.device->can_have(place.place)) return;  // so it will move
  const auto [entry, added] = on_buses_.emplace(std::pair(place.bus, place.place), taken);
  OnBus& known = entry->second;
  const bool other = taken.device != nullptr && known.device != nullptr;
  if (!added && (alone || known.alone || (other && taken.device != known.device)))
    return report_taken(known, place, said->span);
  if (!added && other && part == nullptr) report_same(known, place, said->span);
  if (known.device != nullptr || taken.device == nullptr) return;
  known.device = taken.device;
  known.span = taken.span;
}

Wiring WiringReader::read(Fields& fields, const WiringType& type, const Board::Part* part,
                          bool two_pins, const std::string& what) {
  Wiring wiring;
  if (type.name == "VIRTUAL") return wiring;
  if (part != nullptr) return read_part(fields, *part);
  report_foreign(fields, type);
  if (const Device* const chip = type.address ? chip_of(fields, nullptr) : nullptr;
      chip != nullptr && chip->addresses.size() == 1)
    assume_address(fields, chip->addresses.front().first);
  if (type.name == "UART") wiring.bus = vm::kFirstPlayerLine;
  if (const auto* bus = type.bus ? fields.find("bus") : nullptr)
    wiring.bus = static_cast<std::uint8_t>(
        read_whole(*bus, 0, UINT8_MAX, diagnostics_).value_or(wiring.bus));
  if (type.address) {
    if (const auto* address = fields.require("address", what))
      wiring.place = static_cast<std::uint16_t>(
          read_address(*address, vm::kFirstAddress, vm::kLastAddress, diagnostics_)
              .value_or(vm::kFirstAddress));
  } else if (type.pin) {
    read_pins(fields, two_pins, what, wiring);
  }
  return wiring;
}

void WiringReader::check_bus(const Fields& fields, const Wiring& wiring) {
  check_bus(fields, wiring, "I2C", board_.i2c_buses);
}

void WiringReader::check_spi(const Fields& fields, const Wiring& wiring) {
  check_bus(fields, wiring, "SPI", board_.spi_buses);
  if (const auto* pin = fields.find("pin"))
    check_special(*pin, wiring.place, board_.selects, kSelect);
  if (wiring.bus >= board_.spi_buses || std::exchange(on_spi_, true)) return;
  const auto* said = fields.find(fields.find("type") != nullptr ? "type" : "device");
  for (std::uint16_t pin = board_.spi_pins.first; pin <= board_.spi_pins.last; ++pin)
    if (pin != wiring.place) take_pin(pin, said->span);  // a select pin of these has been reported
}

void WiringReader::check_bus(const Fields& fields, const Wiring& wiring, const char* kind,
                             std::uint32_t buses) {
  if (wiring.bus < buses || board_.named == Board::Named::wrongly) return;
  const auto* bus = fields.find("bus");
  if (bus == nullptr) bus = fields.find("type");
  Diagnostic& report = diagnostics_
                           .report(Code::E0205, fmt::format("the board {} has no {} bus {}",
                                                            board_.name, kind, wiring.bus))
                           .label(bus->span);
  if (buses != 0)
    report.helps(buses == 1 ? "it has only bus 0"
                            : "its buses are 0 to " + std::to_string(buses - 1));
}

// Each serial line connects one player.
void WiringReader::check_line(const Fields& fields, const Wiring& wiring) {
  const auto* bus = fields.find("bus");
  if (bus == nullptr) bus = fields.find(fields.find("device") != nullptr ? "device" : "type");
  const Span span = bus->span;
  const std::string line = "serial line " + std::to_string(wiring.bus);
  if (wiring.bus < vm::kFirstPlayerLine ||
      wiring.bus >= vm::kFirstPlayerLine + board_.serial_lines) {
    diagnostics_
        .report(Code::E0205, "the board " + board_.name + " has no " + line + " for programs")
        .label(span)
        .helps(board_.serial_lines == 1
                   ? "it has only `\"bus\": 1`"
                   : "its serial lines are 1 to " + std::to_string(board_.serial_lines));
    return;
  }
  const auto [first, added] = lines_.emplace(wiring.bus, span);
  if (added && board_.player_pin) take_pin(*board_.player_pin, span);
  if (added) return;
  diagnostics_.report(Code::E0207, line + " is used twice")
      .label(span)
      .label(first->second, "first used here", false);
}

void WiringReader::check_output(const Fields& fields, const Wiring& wiring, vm::DriverId driver) {
  const bool power = vm::gives_power(driver);
  if (vm::has_two_pins(driver)) {
    const auto* pins = fields.find("pins");
    if (pins == nullptr || pins->items.size() != 2) return;
    check_output_pin(pins->items[0], wiring.place, power);
    check_output_pin(pins->items[1], wiring.bus, power);
  } else if (const auto* pin = fields.find("pin")) {
    check_output_pin(*pin, wiring.place, power);
  }
}

void WiringReader::check_panel(const Fields& fields, const Wiring& wiring) {
  const auto* pin = fields.find("pin");
  if (pin != nullptr) check_special(*pin, wiring.place, board_.panels, kPanel);
  const Span span = fields.find("device")->span;
  if (!panel_) {
    panel_ = span;
    return;
  }
  diagnostics_.report(Code::E0207, "a robot can have only one panel or strip of lights")
      .label(span)
      .label(*panel_, "the first one", false);
}

void WiringReader::check_special(const json::Value& value, std::uint16_t pin,
                                 std::span<const Board::Pins> those, const SpecialPins& use) {
  for (const Board::Pins& pins : those)
    if (pin >= pins.first && pin <= pins.last) return;
  if (!those.empty())
    return report_no_pin(value, pin, std::string(" is not ") + use.pin_is_not, use.those, those);
  if (board_.named == Board::Named::wrongly) return;
  diagnostics_.report(Code::E0205, "the board " + board_.name + " has no " + use.board_has_no)
      .label(value.span)
      .helps(use.boards + boards_that(use.have));
}

// A pin that is limited to servo pulses cannot drive a motor (policy::can_drive()).
void WiringReader::check_output_pin(const json::Value& value, std::uint16_t pin, bool power) {
  if (board_.has_output(pin) && (!power || board_.gives_power(pin))) return;
  std::vector<Board::Pins> those;
  std::ranges::copy_if(board_.outputs, std::back_inserter(those),
                       [power](const Board::Pins& pins) { return pins.power || !power; });
  const bool all = those.size() == board_.outputs.size();
  report_no_pin(
      value, pin,
      board_.has_output(pin) ? " gives only pulses for servos, no power" : " is not an output",
      all ? "its outputs are the pins " : "pins that give power: ", those);
}

void WiringReader::check_input(const Fields& fields, const Wiring& wiring) {
  const auto* pin = fields.find("pin");
  if (pin != nullptr && !board_.has_input(wiring.place))
    report_no_pin(*pin, wiring.place, " is not an input", "its inputs are the pins ",
                  board_.inputs);
}

void WiringReader::check_echo(const Fields& fields, const Wiring& wiring) {
  const auto* trigger = fields.find("trigger");
  const auto* echo = fields.find("echo");
  if (trigger == nullptr || echo == nullptr) return;
  check_output_pin(*trigger, wiring.bus, true);
  if (!board_.has_echo(wiring.place))
    report_no_pin(*echo, wiring.place, " is not an input for an echo",
                  "those that are: ", board_.echoes);
}

void WiringReader::check_analog(const Fields& fields, const Wiring& wiring) {
  if (const auto* pin = fields.find("pin"))
    check_special(*pin, wiring.place, board_.analog, kAnalog);
}

void WiringReader::report_no_pin(const json::Value& value, std::uint16_t pin,
                                 const std::string& is_no, const std::string& those_are,
                                 std::span<const Board::Pins> those) {
  // A value that is not a pin has been reported. Nothing can be said about an unknown board.
  Diagnostics said;
  if (board_.named == Board::Named::wrongly || read_whole(value, 0, UINT16_MAX, said) != pin)
    return;
  // It will have another pin, so nobody uses this one twice.
  const auto is_here = [&](Span span) { return span.begin == value.span.begin; };
  std::erase_if(pins_, [&](const auto& taken) { return is_here(taken.second); });
  std::erase_if(pins_twice_,
                [&](const UsedTwice& one) { return is_here(one.span) || is_here(one.first); });
  diagnostics_
      .report(Code::E0205, "on the board " + board_.name + " pin " + std::to_string(pin) + is_no)
      .label(value.span)
      .helps(those_are + list_pins(those));
}

std::optional<std::size_t> read_choice(const json::Value& value,
                                       std::span<const std::string_view> names,
                                       Diagnostics& diagnostics) {
  const auto text = read_text(value, diagnostics);
  if (!text) return std::nullopt;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (same_name(names[i], *text)) return i;
  const std::vector<std::string> candidates(names.begin(), names.end());
  Diagnostic& d =
      diagnostics.report(Code::E0205, "`" + *text + "` is not allowed here").label(value.span);
  if (!did_you_mean(d, value.span, *text, candidates, "\""))
    d.helps("it can be " + list_names(candidates, "or"));
  doubt_numbered(d, *text);
  return std::nullopt;
}

std::optional<vm::Release> read_release(const json::Value& value, Diagnostics& diagnostics) {
  const auto choice = read_choice(value, kReleases, diagnostics);
  if (!choice) return std::nullopt;
  return static_cast<vm::Release>(*choice);
}

const Unit& param_unit(const ActuatorConfig& actuator, vm::Param param, const VerbConfig* verb) {
  if (verb != nullptr && verb->by_unit != nullptr && param == vm::Param::by) return *verb->by_unit;
  const Unit& number = canonical_unit(vm::Dimension::number);
  switch (param) {
    case vm::Param::to:
    case vm::Param::by:
      return actuator.to_unit != nullptr ? *actuator.to_unit : number;
    case vm::Param::at:
      return actuator.at_unit != nullptr ? *actuator.at_unit : number;
    case vm::Param::over:
    case vm::Param::for_:
      return canonical_unit(vm::Dimension::duration);
    default:
      return number;
  }
}

}  // namespace robosync::compiler
