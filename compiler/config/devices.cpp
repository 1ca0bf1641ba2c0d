// Turns device descriptors into templates for sensors and actuators.
#include "compiler/config/devices.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "compiler/config/entries.hpp"
#include "compiler/config/fields.hpp"
#include "compiler/config/json_reader.hpp"
#include "compiler/config/values.hpp"
#include "compiler/config/wiring.hpp"
#include "vm/drivers.hpp"

namespace robosync::compiler {
namespace {

// The enumerators, by their names in the .def lists.
constexpr std::array<std::string_view, static_cast<std::size_t>(vm::DriverId::count_)> kDrivers = {
#define SENSOR_DRIVER(name, ...) #name,
#define ACTUATOR_DRIVER(name, ...) #name,
#include "vm/drivers.def"
#undef SENSOR_DRIVER
#undef ACTUATOR_DRIVER
};
constexpr std::array<std::string_view, static_cast<std::size_t>(vm::Param::count_)> kParams = {
#define PARAM(name, spelling, doc) #name,
#include "vm/params.def"
#undef PARAM
};
// The actions that a device can have.
constexpr std::array<std::string_view, static_cast<std::size_t>(vm::Action::perform)> kActions = {
    "move", "play", "set", "stop"};
constexpr std::array<std::string_view, 3> kTexts = {"none", "listed", "any"};

template <typename Enum, std::size_t size>
Enum read_enum(const json::Value& value, const std::array<std::string_view, size>& names,
               Diagnostics& diagnostics) {
  return static_cast<Enum>(read_choice(value, names, diagnostics).value_or(0));
}

VerbConfig read_verb(const json::Member& member, Diagnostics& diagnostics) {
  Fields fields(member.value, Object::verb, diagnostics);
  VerbConfig verb{member.key, {}, 0, Texts::none, nullptr};
  if (const auto* action = fields.require("action", "a verb"))
    verb.action = read_enum<vm::Action>(*action, kActions, diagnostics);
  if (const auto* texts = fields.find("texts"))
    verb.texts = read_enum<Texts>(*texts, kTexts, diagnostics);
  if (const auto* by = fields.find("by")) verb.by_unit = read_unit(*by, diagnostics);
  if (const auto* takes = fields.find("takes"))
    for (const json::Value& item : takes->items)
      verb.takes =
          static_cast<std::uint8_t>(verb.takes | 1u << static_cast<unsigned>(read_enum<vm::Param>(
                                                     item, kParams, diagnostics)));
  return verb;
}

// ["MOVE", "DRIVE"]: verbs of this device.
std::vector<std::string> read_verbs_of_word(const json::Value& list, const ActuatorConfig& actuator,
                                            Diagnostics& diagnostics) {
  std::vector<std::string> verbs;
  if (!expect_kind(list, json::Kind::array, diagnostics)) return verbs;
  verbs.reserve(list.items.size());
  for (const json::Value& item : list.items) {
    const VerbConfig* verb = actuator.find_verb(item.text);
    if (verb == nullptr)
      diagnostics.report(Code::E0202, "no verb `" + item.text + "`").label(item.span);
    else
      verbs.push_back(verb->name);
  }
  return verbs;
}

// {"SLOWLY": {"at": "30deg/s"}, "LEFT": {"verbs": ["TURN"], "direction": -1}}
void read_word(const json::Member& member, ActuatorConfig& actuator, Diagnostics& diagnostics) {
  if (!expect_kind(member.value, json::Kind::object, diagnostics)) return;
  const std::size_t first = actuator.words.size();
  std::vector<std::string> verbs;
  for (const json::Member& setting : member.value.members) {
    if (setting.key == "verbs") {
      verbs = read_verbs_of_word(setting.value, actuator, diagnostics);
      continue;
    }
    const auto named = std::find(kParams.begin(), kParams.end(), setting.key);
    if (named == kParams.end()) {
      diagnostics.report(Code::E0202, "no parameter `" + setting.key + "`").label(setting.key_span);
      continue;
    }
    const auto param = static_cast<vm::Param>(named - kParams.begin());
    const Unit& unit = param_unit(actuator, param);
    const auto value = read_quantity(setting.value, unit, diagnostics);
    actuator.words.push_back({member.key, param, value.value_or(0), false, {}});
  }
  for (std::size_t i = first; i < actuator.words.size(); ++i)
    actuator.words[i].verbs = verbs;
}

// How long a virtual actuator takes: as long as the real one would.
void read_model(const json::Value& value, ActuatorConfig& actuator, Diagnostics& diagnostics) {
  const Fields fields(value, Object::model, diagnostics);
  if (const auto* speed = fields.find("speed"))
    if (actuator.at_unit != nullptr)
      actuator.usual_speed = static_cast<std::uint16_t>(
          read_quantity(*speed, *actuator.at_unit, diagnostics).value_or(0) / vm::kScale);
  if (const auto* sweeps = fields.find("sweeps")) actuator.sweeps = sweeps->truth;
  if (const auto* word = fields.find("word"))
    actuator.word_length = read_milliseconds(*word, diagnostics).value_or(0);
}

void read_actuator_device(const Fields& fields, Device& device, Diagnostics& diagnostics) {
  ActuatorConfig& actuator = device.actuator;
  if (const auto* to = fields.find("to")) {
    const Fields to_fields(*to, Object::device_to, diagnostics);
    if (const auto* unit = to_fields.find("unit")) actuator.to_unit = read_unit(*unit, diagnostics);
    const auto* range = to_fields.find("range");
    if (range != nullptr && actuator.to_unit != nullptr) {
      const auto read = read_range(*range, *actuator.to_unit, diagnostics).value_or(Range{});
      actuator.min = read.low;
      actuator.max = read.high;
      const auto* widest = to_fields.find("widest");
      const auto limits = widest == nullptr
                              ? read
                              : read_range(*widest, *actuator.to_unit, diagnostics).value_or(read);
      actuator.lowest = limits.low;
      actuator.highest = limits.high;
    }
  }
  if (const auto* at = fields.find("at")) {
    const Fields at_fields(*at, Object::device_at, diagnostics);
    if (const auto* unit = at_fields.find("unit")) actuator.at_unit = read_unit(*unit, diagnostics);
  }
  if (const auto* release = fields.find("on_release"))
    actuator.on_release = read_release(*release, diagnostics).value_or(actuator.on_release);
  if (const auto* safe = fields.find("safe"))
    actuator.safe = read_release(*safe, diagnostics).value_or(actuator.safe);
  if (const auto* sounds = fields.find("sounds")) device.has_sounds = sounds->truth;
  if (const auto* model = fields.find("model")) read_model(*model, actuator, diagnostics);
  if (const auto* verbs = fields.find("verbs"))
    for (const json::Member& member : verbs->members)
      actuator.verbs.push_back(read_verb(member, diagnostics));
  if (const auto* words = fields.find("words"))
    for (const json::Member& member : words->members)
      read_word(member, actuator, diagnostics);
}

// [["0x1c", "0x1f"], ["0x2a", "0x2a"]]
void read_addresses(const json::Value& value, Device& device, Diagnostics& diagnostics) {
  if (!expect_kind(value, json::Kind::array, diagnostics)) return;
  for (const json::Value& item : value.items) {
    if (item.items.size() != 2) {
      diagnostics.report(Code::E0205, "a row of addresses has a first and a last one")
          .label(item.span);
      continue;
    }
    const auto read = [&](const json::Value& address) {
      return static_cast<std::uint16_t>(
          read_whole(address, vm::kFirstAddress, vm::kLastAddress, diagnostics).value_or(0));
    };
    device.addresses.push_back({read(item.items[0]), read(item.items[1])});
  }
}

void read_sensor_device(const Fields& fields, Device& device, Diagnostics& diagnostics) {
  if (const auto* addresses = fields.find("addresses"))
    read_addresses(*addresses, device, diagnostics);
  if (const auto* every = fields.find("measures_every"))
    device.measures_every_ms = read_milliseconds(*every, diagnostics).value_or(0);
  if (const auto* volts = fields.find("volts"))
    device.volts =
        read_quantity(*volts, canonical_unit(vm::Dimension::voltage), diagnostics).value_or(0);
  if (const auto* inputs = fields.find("inputs"))
    device.inputs = static_cast<unsigned>(
        read_whole(*inputs, 1, kRegisters, diagnostics).value_or(device.inputs));
  const auto* channels = fields.find("channels");
  if (channels == nullptr) return;
  for (const json::Member& member : channels->members) {
    ChannelConfig channel;
    channel.name = {member.key, {}};
    channel.unit = &canonical_unit(vm::Dimension::number);
    read_channel(member.value, device.inputs, channel, diagnostics);
    device.sensor.channels.push_back(std::move(channel));
  }
}

// Most programs need few descriptors, so each is read when it is first needed.
template <typename Predicate>
const Device* find_if(Predicate predicate) {
  static std::map<std::string_view, Device> read;
  const auto all = device_texts();
  const auto text = std::find_if(all.begin(), all.end(), predicate);
  if (text == all.end()) return nullptr;
  if (const auto known = read.find(text->name); known != read.end()) return &known->second;
  Diagnostics diagnostics;  // a test checks that the built-in descriptors have no mistakes
  return &read.emplace(text->name, read_device(*text, diagnostics)).first->second;
}

}  // namespace

bool Device::is_generic() const {
  return sensor.channels.size() == 1 && sensor.channels.front().name.text == "LEVEL";
}

bool Device::can_have(std::uint16_t address) const {
  return addresses.empty() || std::ranges::any_of(addresses, [&](const Addresses& row) {
           return address >= row.first && address <= row.last;
         });
}

std::uint16_t Device::shortest_period_ms() const {
  return std::max(measures_every_ms, vm::min_period_ms(sensor.driver));
}

Device read_device(const DeviceText& text, Diagnostics& diagnostics) {
  SourceMap sources;
  const FileId file = sources.add(std::string(text.name), std::string(text.json));
  Device device;
  device.name = text.name;
  const auto tree = json::read(sources, file, diagnostics);
  if (!tree) return device;
  Fields fields(*tree, Object::device, diagnostics);
  const auto* kind = fields.require("kind", "a device");
  const auto* type = fields.require("type", "a device");
  if (kind == nullptr || type == nullptr) return device;
  constexpr std::array<std::string_view, 2> kKinds = {"actuator", "sensor"};
  device.is_sensor = read_choice(*kind, kKinds, diagnostics).value_or(0) == 1;
  device.type = type->text;
  if (const auto* doc = fields.find("doc")) device.doc = doc->text;
  if (const auto* is_default = fields.find("default")) device.is_default = is_default->truth;
  auto driver = device.is_sensor ? vm::DriverId::virtual_sensor : vm::DriverId::virtual_actuator;
  if (const auto* named = fields.find("driver")) {
    driver = read_enum<vm::DriverId>(*named, kDrivers, diagnostics);
    device.has_driver = true;
  }
  device.sensor.device = device.name;
  device.actuator.device = device.name;
  device.sensor.driver = driver;
  device.actuator.driver = driver;
  if (device.is_sensor)
    read_sensor_device(fields, device, diagnostics);
  else
    read_actuator_device(fields, device, diagnostics);
  return device;
}

const Device* find_device(std::string_view name, bool is_sensor) {
  return find_if([&](const DeviceText& device) {
    return device.is_sensor == is_sensor && same_name(device.name, name);
  });
}

const Device* default_device(std::string_view type, bool is_sensor) {
  return find_if([&](const DeviceText& device) {
    return device.is_sensor == is_sensor && device.is_default && device.type == type;
  });
}

bool gets_power(const ActuatorConfig& actuator) {
  const Device* const device = find_device(actuator.device, false);
  return device != nullptr && vm::gives_power(device->actuator.driver);
}

std::vector<std::string> devices_with(std::string_view verb) {
  std::vector<std::string> able;
  for (const DeviceText& text : device_texts()) {
    const Device* const device = text.is_sensor ? nullptr : find_device(text.name, false);
    if (device != nullptr && device->actuator.find_verb(verb) != nullptr)
      able.emplace_back(text.name);
  }
  return able;
}

}  // namespace robosync::compiler
