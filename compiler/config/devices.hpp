// The devices that rsc knows: stdlib/devices/*.json, built into the library.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/config/robot.hpp"

namespace robosync::compiler {

inline constexpr unsigned kRegisters = 256;

struct Device {
  std::string name;
  bool is_sensor = false;
  std::string type;         // how it is wired: "I2C"
  bool has_driver = false;  // false: this version has none; values go over the link
  bool is_default = false;  // the default for its type, if robot.json names no device
  unsigned inputs = 1;
  bool has_sounds = false;
  SensorConfig sensor;  // the starting values for an entry in robot.json, by kind
  ActuatorConfig actuator;

  // True if any of its registers may be read: robot.json says which.
  [[nodiscard]] bool has_registers() const { return inputs == kRegisters; }
};

struct DeviceText {  // one built-in descriptor, and the keys it is found by
  std::string_view name;
  std::string_view json;
  bool is_sensor = false;
  std::string_view type{};
  bool is_default = false;
};
[[nodiscard]] std::span<const DeviceText> device_texts();

// Reads one descriptor and reports its mistakes. A test checks that the built-in ones have none.
[[nodiscard]] Device read_device(const DeviceText& text, Diagnostics& diagnostics);

// Reads the descriptor on demand. The case of names does not matter. nullptr if there is no such device of this kind.
[[nodiscard]] const Device* find_device(std::string_view name, bool is_sensor);
[[nodiscard]] const Device* default_device(std::string_view type, bool is_sensor);
// True if TO and AT set its power. Also true for a virtual actuator that replaces such a device.
[[nodiscard]] bool gets_power(const ActuatorConfig& actuator);
// The devices that know `verb`, whose case does not matter. Reads every actuator's descriptor: for messages only.
[[nodiscard]] std::vector<std::string> devices_with(std::string_view verb);

}  // namespace robosync::compiler
