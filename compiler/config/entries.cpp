// What entries of sensors and actuators share: a name, a type, a device.
#include "compiler/config/entries.hpp"

#include <algorithm>
#include <array>

#include "compiler/config/names.hpp"
#include "compiler/config/values.hpp"
#include "compiler/diagnostics/nearest.hpp"
#include "vm/drivers.hpp"

namespace robosync::compiler {
namespace {

constexpr std::string_view kVirtual = "VIRTUAL";

struct CommonDevice {
  std::string_view name, device;
};
constexpr CommonDevice kCommonDevices[] = {
#define COMMON_DEVICE(name, device) {name, device},
#include "compiler/config/common_devices.def"
#undef COMMON_DEVICE
};

// `"device": "led"`
bool helps_with_common_device(const json::Value& value, bool is_sensor, Diagnostic& diagnostic) {
  const auto* const found = std::ranges::find_if(kCommonDevices, [&](const CommonDevice& one) {
    return same_name(one.name, value.text) && find_device(one.device, is_sensor) != nullptr;
  });
  if (found == std::end(kCommonDevices)) return false;
  const std::string device(found->device);
  diagnostic.helps("such a part is the device `" + device + "`, see docs/devices.md#" + device)
      .fix(value.span, "\"" + device + "\"", Applicability::likely);
  return true;
}

bool is_kind(const Board::Part& part, bool is_sensor) {
  return find_device(part.device, is_sensor) != nullptr;
}

// The board's own parts first: a message shows only the first names.
std::vector<std::string> device_names(const Board& board, bool is_sensor) {
  std::vector<std::string> names;
  for (const Board::Part& part : board.parts)
    if (is_kind(part, is_sensor) && find_device(part.name, is_sensor) == nullptr)
      names.push_back(part.name);
  for (const DeviceText& device : device_texts())
    if (device.is_sensor == is_sensor) names.emplace_back(device.name);
  return names;
}

// The first board that has such a part.
std::string_view owner_of(std::string_view part) {
  const auto names = board_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (board_at(i).find_part(part) != nullptr) return names[i];
  return {};
}

// Reports a part of a board if robot.json names no board, once. A wrong board has already been reported.
void report_no_board(const json::Value& value, std::string_view owner, const Board& board,
                     Diagnostics& diagnostics) {
  const std::string message = "robot.json does not say which board this robot has";
  const bool said = std::ranges::any_of(
      diagnostics.all(), [&](const Diagnostic& one) { return one.message == message; });
  if (said || board.named == Board::Named::wrongly) return;
  diagnostics.report(Code::E0206, message)
      .label(value.span, "a part of a board")
      .helps("add the one with `" + value.text + "`: `\"board\": \"" + std::string(owner) + "\"`");
}

void report_unknown_device(const json::Value& value, const Board& board, bool is_sensor,
                           Diagnostics& diagnostics) {
  const std::string_view owner = owner_of(value.text);
  if (!owner.empty() && board.named != Board::Named::well)
    return report_no_board(value, owner, board, diagnostics);
  const Board::Part* const part = board.find_part(value.text);
  if (find_device(part != nullptr ? part->device : value.text, !is_sensor) != nullptr) {
    const std::string list = is_sensor ? "actuators" : "sensors";
    diagnostics
        .report(Code::E0208,
                "a `" + value.text + "` is " +
                    (is_sensor ? "an actuator, not a sensor" : "a sensor, not an actuator"))
        .label(value.span)
        .helps("it belongs in the list `\"" + list + "\"`");
    return;
  }
  const std::vector<std::string> candidates = device_names(board, is_sensor);
  Diagnostic& d =
      diagnostics.report(Code::E0208, "rsc knows no device `" + value.text + "`").label(value.span);
  if (!owner.empty() && owner != board.name)
    d.helps("it is on the board " + std::string(owner) + ", but this robot has the board " +
            board.name);
  else if (!helps_with_common_device(value, is_sensor, d) &&
           !did_you_mean(d, value.span, value.text, candidates, "\""))
    d.helps("known devices: " + list_names(candidates));
  doubt_numbered(d, value.text);
}

// The device that "device" names, if it is of this kind.
const Device* named_device(const json::Value& value, const Board& board, bool is_sensor,
                           Diagnostics& diagnostics) {
  if (!read_text(value, diagnostics)) return nullptr;
  const Board::Part* part = board.find_part(value.text);
  const Device* device = find_device(part != nullptr ? part->device : value.text, is_sensor);
  if (device == nullptr) report_unknown_device(value, board, is_sensor, diagnostics);
  return device;
}

const WiringType* type_of(const Device& device) {
  const auto types = wiring_types();
  const auto found = std::ranges::find(types, device.type, &WiringType::name);
  return found == types.end() ? nullptr : &*found;
}

const WiringType* virtual_type() {
  return &*std::ranges::find(wiring_types(), kVirtual, &WiringType::name);
}

std::string what_it_does(bool is_sensor) {
  return is_sensor ? "its readings come over the link" : "its commands are sent over the link";
}

void say_assumed(const Device& device, const Spelled& name, Diagnostics& diagnostics) {
  std::string assumed =
      "`" + name.text + "` is assumed to be the generic device `" + device.name + "`";
  if (device.is_sensor) {
    const ChannelConfig& channel = device.sensor.channels.front();
    assumed += ": one channel " + channel.name.text;
    const std::string_view unit = channel.unit->spelling;
    if (channel.period_ms != 0)
      assumed += (unit.empty() ? ", raw counts" : ", in " + std::string(unit)) + ", read every " +
                 std::to_string(channel.period_ms) + " ms";
  }
  diagnostics.report(Code::N0001, assumed)
      .label(name.span)
      .helps(device.is_sensor ? "specify it with \"device\", or with \"channels\" and their units"
                              : "specify it with \"device\"");
}

// What to write in place of a type without a driver.
std::string other_than(std::string_view type, bool is_sensor) {
  std::string feeds = is_sensor ? "`\"type\": \"VIRTUAL\"` says that it is fed"
                                : "`\"type\": \"VIRTUAL\"` says that it has no hardware";
  if (type == "UART")
    return "the serial line of a board is for a sound player, `\"device\": \"dfplayer\"`; " + feeds;
  if (type == "GPIO")
    return (is_sensor ? "for the level of the pin write `\"device\": \"switch\"`; "
                      : "to switch the pin on and off write `\"type\": \"PWM\"`; ") +
           feeds;
  return feeds;
}

// A microphone, a logo and a thermometer cannot be wired. On a board that has none, it is fed.
bool is_fed_here(const Device* device, const Board::Part* part) {
  return device != nullptr && part == nullptr && vm::is_of_board(device->sensor.driver);
}

// The keys of the wiring: keys_of_wiring() has those that a device takes.
constexpr std::array<std::string_view, 10> kWiringKeys = {
    "bus",  "address",         "pin",  "pins", "channel", "enable", "trigger",
    "echo", "pulses_per_turn", "wheel"};

constexpr std::array<std::string_view, 1> kPin = {"pin"};

bool has(std::span<const std::string_view> keys, std::string_view key) {
  return std::ranges::find(keys, key) != keys.end();
}

}  // namespace

bool may_have(const Fields& fields, bool is_sensor, std::string_view key) {
  const auto* const named = fields.find("device");
  const auto* const type = fields.find("type");
  const bool is_virtual = type != nullptr && same_name(type->text, kVirtual);
  const Device* const device = named != nullptr  ? find_device(named->text, is_sensor)
                               : type != nullptr ? default_device(type->text, is_sensor)
                                                 : nullptr;
  if (device == nullptr) return true;
  if (has(kWiringKeys, key))
    return is_virtual || (key == "pins" && vm::counts_edges(device->sensor.driver)) ||
           has(keys_of_wiring(*device), key);
  if (key == "register") return device->has_registers();
  if (key == "format") return device->sensor.driver == vm::DriverId::spi_register;
  if (key == "active")
    return device->type == "GPIO" && std::ranges::equal(keys_of_wiring(*device), kPin);
  return is_sensor || may_have(*device, key);
}

std::optional<Spelled> read_name(Fields& fields, std::string_view what, Diagnostics& diagnostics) {
  const auto* value = fields.require("name", what);
  if (value == nullptr) return std::nullopt;
  const auto text = read_text(*value, diagnostics);
  if (!text) return std::nullopt;
  Spelled name{*text, value->span};
  check_name(name, diagnostics);
  return name;
}

const Board::Part* find_part(const Fields& fields, const Board& board, bool is_sensor) {
  const auto* device = fields.find("device");
  const Board::Part* part = device == nullptr ? nullptr : board.find_part(device->text);
  return part != nullptr && is_kind(*part, is_sensor) ? part : nullptr;
}

// Without "type", the device determines it. A part of another board needs no wiring either; choose_device() reports that it is
// not on this board.
const WiringType* choose_type(Fields& fields, const Board::Part* part, bool is_sensor,
                              Diagnostics& diagnostics) {
  const auto* named = fields.find("device");
  const Device* device = named == nullptr
                             ? nullptr
                             : find_device(part != nullptr ? part->device : named->text, is_sensor);
  // choose_device() reports an unknown device.
  if (fields.find("type") == nullptr && is_fed_here(device, part)) return virtual_type();
  if (fields.find("type") == nullptr && named != nullptr)
    return device != nullptr ? type_of(*device) : nullptr;
  if (named != nullptr && device == nullptr && find_device(named->text, !is_sensor) != nullptr)
    return nullptr;
  const WiringType* type = read_type(fields, is_sensor, diagnostics);
  if (device == nullptr || type == nullptr || type->name == kVirtual || type->name == device->type)
    return type;
  diagnostics
      .report(Code::E0205, "a " + device->name + " is wired by " + device->type + ", not by " +
                               std::string(type->name))
      .label(named->span)
      .helps("remove its `type`: it is not needed");
  return nullptr;  // so foreign keys cannot be checked
}

const Device& virtual_device(bool is_sensor) {
  return *default_device(kVirtual, is_sensor);
}

const Device* choose_device(const Fields& fields, const WiringType* type, const Spelled& name,
                            const Board& board, bool is_sensor, Diagnostics& diagnostics) {
  const Device* const fallback = &virtual_device(is_sensor);
  const Device* device = nullptr;
  if (const auto* value = fields.find("device")) {
    device = named_device(*value, board, is_sensor, diagnostics);
    if (device == nullptr) return nullptr;
  } else if (type == nullptr) {
    return fallback;
  } else {
    device = default_device(type->name, is_sensor);
    if (device != nullptr && device->has_driver && type->name != kVirtual)
      say_assumed(*device, name, diagnostics);
  }
  const bool is_virtual = type != nullptr && type->name == kVirtual;
  if (!is_virtual && (device == nullptr || !device->has_driver)) {
    std::string thing = device != nullptr && fields.find("device") != nullptr
                            ? "a `" + device->name + "`"
                            : std::string(type->name) + " " + (is_sensor ? "sensors" : "actuators");
    diagnostics
        .report(Code::W0212, "this version has no driver for " + thing + ": `" + name.text +
                                 "` is virtual, " + what_it_does(is_sensor))
        .label(name.span)
        .helps(other_than(type->name, is_sensor));
  }
  return device == nullptr ? fallback : device;
}

}  // namespace robosync::compiler
