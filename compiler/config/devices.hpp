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
  bool has_driver = false;  // false: this version has none; it is fed or shown over the link
  bool is_default = false;  // stands for its type when robot.json names no device
  unsigned inputs = 1;
  bool has_sounds = false;
  SensorConfig sensor;  // what robot.json's entry starts from, by kind
  ActuatorConfig actuator;

  // Any register of it may be read: robot.json says which.
  [[nodiscard]] bool has_registers() const { return inputs == kRegisters; }
};

struct DeviceText {  // one descriptor as built in, and what it is found by
  std::string_view name;
  std::string_view json;
  bool is_sensor = false;
  std::string_view type{};
  bool is_default = false;
};
[[nodiscard]] std::span<const DeviceText> device_texts();

// Reads one descriptor. Mistakes in it are reported; the tests hold the built-in ones to none.
[[nodiscard]] Device read_device(const DeviceText& text, Diagnostics& diagnostics);

// A descriptor is read when it is asked for. Any case; nullptr when there is none of this kind.
[[nodiscard]] const Device* find_device(std::string_view name, bool is_sensor);
[[nodiscard]] const Device* default_device(std::string_view type, bool is_sensor);
// Do TO and AT say how much power it gets? Of a virtual one, too, which does what the real one will.
[[nodiscard]] bool gets_power(const ActuatorConfig& actuator);
// The names of those that know `verb`, in any case. Reads every actuator's descriptor: for messages.
[[nodiscard]] std::vector<std::string> devices_with(std::string_view verb);

}  // namespace robosync::compiler
