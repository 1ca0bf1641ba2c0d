// What sensors and actuators have in common: a name, a type, a device.
#include "compiler/config/entries.hpp"

#include "compiler/config/values.hpp"
#include "compiler/diagnostics/nearest.hpp"

namespace robosync::compiler {
namespace {

constexpr std::string_view kVirtual = "VIRTUAL";

void report_unknown_device(const json::Value& value, bool is_sensor, Diagnostics& diagnostics) {
  std::vector<std::string> candidates;
  for (const DeviceText& device : device_texts())
    if (device.is_sensor == is_sensor) candidates.emplace_back(device.name);
  Diagnostic& d =
      diagnostics.report(Code::E0208, "rsc knows no device `" + value.text + "`").label(value.span);
  if (const auto near = nearest(value.text, candidates))
    d.helps("did you mean `" + *near + "`?").fix(value.span, "\"" + *near + "\"");
  else
    d.helps("known devices: " + list_names(candidates));
}

// The device that "device" names, if there is one of this kind and type.
const Device* named_device(const json::Value& value, const WiringType* type, bool is_sensor,
                           Diagnostics& diagnostics) {
  if (!read_text(value, diagnostics)) return nullptr;
  const Device* device = find_device(value.text, is_sensor);
  if (device == nullptr) {
    report_unknown_device(value, is_sensor, diagnostics);
  } else if (type != nullptr && type->name != kVirtual && type->name != device->type) {
    diagnostics
        .report(Code::E0205, "a " + device->name + " is wired by " + device->type + ", not by " +
                                 std::string(type->name))
        .label(value.span);
  }
  return device;
}

std::string what_it_does(bool is_sensor) {
  return is_sensor ? "its readings come over the link" : "its commands are shown over the link";
}

void say_assumed(const Device& device, const Spelled& name, Diagnostics& diagnostics) {
  std::string assumed = "`" + name.text + "` is taken as the generic device `" + device.name + "`";
  if (device.is_sensor) {
    const ChannelConfig& channel = device.sensor.channels.front();
    assumed += ": one channel " + channel.name.text;
    if (channel.period_ms != 0)
      assumed += ", raw counts, read every " + std::to_string(channel.period_ms) + " ms";
  }
  diagnostics.report(Code::N0001, assumed)
      .label(name.span)
      .helps(device.is_sensor
                 ? "say what it is with \"device\", or with \"channels\" and their units"
                 : "say what it is with \"device\"");
}

}  // namespace

std::optional<Spelled> read_name(Fields& fields, std::string_view what, Diagnostics& diagnostics) {
  const auto* value = fields.require("name", what);
  if (value == nullptr) return std::nullopt;
  const auto text = read_text(*value, diagnostics);
  if (!text) return std::nullopt;
  Spelled name{*text, value->span};
  check_name(name, diagnostics);
  return name;
}

const Device& choose_device(const Fields& fields, const WiringType* type, const Spelled& name,
                            bool is_sensor, Diagnostics& diagnostics) {
  const Device& fallback = *default_device(kVirtual, is_sensor);
  const Device* device = nullptr;
  if (const auto* value = fields.find("device")) {
    device = named_device(*value, type, is_sensor, diagnostics);
    if (device == nullptr) return fallback;
  } else if (type == nullptr) {
    return fallback;
  } else {
    device = default_device(type->name, is_sensor);
    if (device != nullptr && type->name != kVirtual) say_assumed(*device, name, diagnostics);
  }
  const bool is_virtual = type != nullptr && type->name == kVirtual;
  if (!is_virtual && (device == nullptr || !device->has_driver)) {
    const std::string thing =
        device != nullptr ? "a `" + device->name + "`"
                          : std::string(type->name) + " " + (is_sensor ? "sensors" : "actuators");
    diagnostics
        .report(Code::W0212, "this version has no driver for " + thing + ": `" + name.text +
                                 "` is virtual, " + what_it_does(is_sensor))
        .label(name.span);
  }
  return device == nullptr ? fallback : *device;
}

}  // namespace robosync::compiler
