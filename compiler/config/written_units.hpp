// The units that a program's author writes, by the names that its image has.
#pragma once

#include <map>
#include <string>

#include "compiler/config/robot.hpp"
#include "compiler/config/units.hpp"

namespace robosync::compiler {

struct ActuatorUnits {
  const Unit* to = nullptr;                 // of TO and BY; null: it has no position
  const Unit* at = nullptr;                 // of AT; null: it has no speed
  std::map<std::string, const Unit*> by{};  // of BY of the verbs that have one of their own
};

// What is not in it is shown in its canonical unit.
struct WrittenUnits {
  std::map<std::string, const Unit*> channels;  // "sensor.CHANNEL"
  std::map<std::string, const Unit*> variables;
  std::map<std::string, ActuatorUnits> actuators;
};

// Those that robot.json says.
[[nodiscard]] inline WrittenUnits units_of(const Robot& robot) {
  WrittenUnits units;
  for (const SensorConfig& sensor : robot.sensors)
    for (const ChannelConfig& channel : sensor.channels)
      units.channels[sensor.name.text + "." + channel.name.text] = channel.unit;
  for (const ActuatorConfig& actuator : robot.actuators) {
    ActuatorUnits& own = units.actuators[actuator.name.text];
    own = {actuator.to_unit, actuator.at_unit};
    for (const VerbConfig& verb : actuator.verbs)
      if (verb.by_unit != nullptr) own.by[verb.name] = verb.by_unit;
  }
  return units;
}

}  // namespace robosync::compiler
