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
  std::string doc;
  bool is_sensor = false;
  std::string type;         // how it is wired: "I2C"
  bool has_driver = false;  // false: this version has none; values go over the link
  bool is_default = false;  // the default for its type, if robot.json names no device
  unsigned inputs = 1;
  struct Addresses {
    std::uint16_t first, last;
  };
  std::vector<Addresses> addresses;  // that its pins can select; empty: any
  // The time between two measurements of the part itself: a sample before the next one would be the last one again. 0: any.
  std::uint16_t measures_every_ms = 0;
  vm::Value volts =
      0;  // the highest voltage that it puts on the board's pins; 0: that of the board
  bool has_sounds = false;
  SensorConfig sensor;  // the starting values for an entry in robot.json, by kind
  ActuatorConfig actuator;

  // True if any of its registers may be read: robot.json says which.
  [[nodiscard]] bool has_registers() const { return inputs == kRegisters; }
  // True if its one channel is only a pattern: robot.json says what a generic device measures.
  [[nodiscard]] bool is_generic() const;
  [[nodiscard]] bool can_have(std::uint16_t address) const;
  // The shortest period that gives a new reading each time: the part's, or the driver's if that is longer.
  [[nodiscard]] std::uint16_t shortest_period_ms() const;
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
