// What a device and a board withstand and can do: addresses, voltages, and the wiring of what has no driver.
#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "compiler/config/devices.hpp"
#include "compiler/config/values.hpp"
#include "compiler/config/wiring.hpp"
#include "compiler/diagnostics/nearest.hpp"

namespace robosync::compiler {
namespace {

std::string name_in(const Fields& fields) {
  const auto* const name = fields.find("name");
  return name != nullptr && !name->text.empty() ? "`" + name->text + "`" : "this";
}

// 0x1c to 0x1f, 0x2a
std::vector<std::string> listed(const Device& device) {
  std::vector<std::string> rows;
  for (const Device::Addresses& row : device.addresses)
    rows.push_back(row.first == row.last
                       ? fmt::format("0x{:02x}", row.first)
                       : fmt::format("0x{:02x} to 0x{:02x}", row.first, row.last));
  return rows;
}

// Where its voltage comes in. On I2C that is where the pull-ups of the part lead.
const json::Value* input_of(const Fields& fields) {
  for (const char* key : {"echo", "pin", "pins", "address"})
    if (const auto* value = fields.find(key)) return value;
  return nullptr;
}

using Keys = std::span<const std::string_view>;

template <std::size_t count>
using KeyList = std::array<std::string_view, count>;
constexpr KeyList<3> kOfEncoder = {"pin", "pulses_per_turn", "wheel"};
constexpr KeyList<4> kOfChannel = {"bus", "address", "channel", "enable"};
constexpr KeyList<4> kOfWheels = {"left", "right", "speed", "track"};
constexpr KeyList<2> kOfEcho = {"trigger", "echo"};
constexpr KeyList<2> kOfStrip = {"pin", "lights"};
constexpr KeyList<1> kPins = {"pins"};
constexpr KeyList<1> kPin = {"pin"};
constexpr KeyList<1> kBus = {"bus"};
constexpr KeyList<2> kBusAndPin = {"bus", "pin"};
constexpr KeyList<2> kBusAndAddress = {"bus", "address"};

// The keys that a device needs instead of those of its type.
Keys own_keys(vm::DriverId driver) {
  if (vm::is_by_echo(driver)) return kOfEcho;
  if (vm::counts_edges(driver)) return kOfEncoder;
  if (vm::drives_channel(driver)) return kOfChannel;
  if (vm::drives_wheels(driver)) return kOfWheels;
  if (vm::has_two_pins(driver)) return kPins;
  return vm::is_strip(driver) ? Keys(kOfStrip) : Keys();
}

Keys keys_of(const WiringType& type) {
  if (!type.bus) return kPin;
  if (type.address) return kBusAndAddress;
  return type.pin ? Keys(kBusAndPin) : Keys(kBus);
}

bool is_part(vm::DriverId driver) {
  return vm::is_of_board(driver) || vm::drives_lights(driver) || vm::drives_speaker(driver);
}

}  // namespace

std::span<const std::string_view> keys_of_wiring(const Device& device) {
  const vm::DriverId driver = device.is_sensor ? device.sensor.driver : device.actuator.driver;
  if (!device.has_driver || is_part(driver)) return {};
  const Keys keys = own_keys(driver);
  return keys.empty() ? keys_of(*std::ranges::find(wiring_types(), device.type, &WiringType::name))
                      : keys;
}

std::string wiring_of(const Device& device) {
  const Keys keys = keys_of_wiring(device);
  std::string text = list_names({keys.begin(), keys.end()});
  if (!text.empty() && !device.addresses.empty()) text += ", " + list_names(listed(device), "or");
  return text;
}

// What has this address on the board, in words; empty: nothing, or the same chip, or it has been reported.
std::string WiringReader::owner_on_board(const Fields& fields, const Wiring& wiring,
                                         Span address) const {
  if (const Board::Reserved* const found = board_.find_reserved(wiring.bus, wiring.place))
    return found->used_for;
  const auto known = on_buses_.find({wiring.bus, wiring.place});
  if (known != on_buses_.end() && known->second.span.begin != address.begin) return {};
  const auto* const said = fields.find("device");
  if (said == nullptr) return {};
  const Device* const device = find_device(said->text, true);
  if (device != nullptr && device->has_registers()) return {};
  const auto part = std::ranges::find_if(board_.parts, [&](const Board::Part& one) {
    return one.address == wiring.place && one.bus == wiring.bus && one.address != 0;
  });
  if (part == board_.parts.end() || same_name(part->device, said->text)) return {};
  return fmt::format("the part `{}` ({})", part->name, part->device);
}

void WiringReader::check_address(const Fields& fields, const Wiring& wiring) {
  const auto* const address = fields.find("address");
  if (address == nullptr) return;
  const std::string owner = owner_on_board(fields, wiring, address->span);
  if (owner.empty()) return;
  diagnostics_
      .report(Code::E0207,
              fmt::format("{} cannot have address 0x{:02x} on bus {}: {} of the board {} has it",
                          name_in(fields), wiring.place, wiring.bus, owner, board_.name))
      .label(address->span)
      .helps("give it another address; many parts have pins or solder bridges for that");
}

bool WiringReader::check_own_address(const Fields& fields, const Wiring& wiring,
                                     const Device& device) {
  const auto* const address = fields.find("address");
  const auto* const said = fields.find("device");
  Diagnostics reported;  // an address that no part can have was reported before
  if (address == nullptr || said == nullptr || device.can_have(wiring.place) ||
      read_whole(*address, vm::kFirstAddress, vm::kLastAddress, reported) != wiring.place)
    return true;
  diagnostics_
      .report(Code::E0205,
              fmt::format("the device {} cannot have address 0x{:02x}", device.name, wiring.place))
      .label(address->span)
      .label(said->span, "this device", false)
      .helps("it can have " + list_names(listed(device), "or"));
  return false;
}

void WiringReader::check_without_driver(const Fields& fields, const WiringType& type,
                                        const Wiring& wiring) {
  if (board_.named == Board::Named::wrongly) return;
  if (type.name == "UART") return check_line(fields, wiring);
  if (type.name == "I2C") {
    check_bus(fields, wiring);
    return check_address(fields, wiring);
  }
  const auto* const pin = fields.find("pin");
  if (pin == nullptr) return;
  const std::vector<Board::Pins> pins = board_.all_pins();
  const bool has = std::ranges::any_of(pins, [&](const Board::Pins& some) {
    return wiring.place >= some.first && wiring.place <= some.last;
  });
  if (!has) report_no_pin(*pin, wiring.place, " is not for programs", "those that are: ", pins);
}

void WiringReader::check_volts(const Fields& fields, vm::Value usual) {
  const Unit& volts = canonical_unit(vm::Dimension::voltage);
  const auto* const said = fields.find("volts");
  vm::Value highest = usual;
  if (said != nullptr) {
    const auto read = read_quantity(*said, volts, diagnostics_);
    if (!read) return;
    highest = *read;
    if (highest <= 0)
      diagnostics_.report(Code::E0205, "this voltage must be above 0").label(said->span);
  }
  const auto* const input = input_of(fields);
  if (input == nullptr || board_.volts == 0 || highest <= board_.volts) return;
  const bool on_bus = fields.find("address") == input;
  const auto* const device = fields.find("device");
  const auto* const from = said != nullptr ? said : device != nullptr ? device : input;
  const std::string high = format_value(highest, volts), limit = format_value(board_.volts, volts);
  diagnostics_
      .report(
          said != nullptr ? Code::E0212 : Code::W0222,
          fmt::format("{} puts {} on {}, but the pins of the board {} withstand {} at most",
                      name_in(fields), high, on_bus ? "the lines of its bus" : "pin " + input->text,
                      board_.name, limit))
      .label(input->span)
      .label(from->span, said != nullptr ? "this voltage" : "a part for " + high, false)
      .helps(fmt::format(
          "{}; then write `\"volts\": {}`",
          on_bus
              ? "connect the pull-ups of the part to " + limit + ", or use a level shifter"
              : "reduce it by two resistors (docs/devices.md#hc-sr04), or use a part for " + limit,
          limit.substr(0, limit.size() - volts.spelling.size())));
}

}  // namespace robosync::compiler
