// Entries of "sensors" and "actuators" in robot.json (sensors.cpp, actuators.cpp), and what they share.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "compiler/config/devices.hpp"
#include "compiler/config/json_reader.hpp"
#include "compiler/config/robot.hpp"
#include "compiler/config/wiring.hpp"

namespace robosync::compiler {

// Returns nullopt only if the entry has no name. Otherwise the entry is usable, so that one mistake does not make its name
// unknown.
[[nodiscard]] std::optional<SensorConfig> read_sensor(const json::Value& value,
                                                      WiringReader& wiring,
                                                      Diagnostics& diagnostics);
// `sensors`: those of the robot.
[[nodiscard]] std::optional<ActuatorConfig> read_actuator(const json::Value& value,
                                                          std::span<const SensorConfig> sensors,
                                                          WiringReader& wiring,
                                                          Diagnostics& diagnostics);

// Reads one channel of a sensor. Overwrites in `channel` what `value` sets; the rest keeps the values of the device descriptor.
// `inputs`: how many inputs the device has.
void read_channel(const json::Value& value, unsigned inputs, ChannelConfig& channel,
                  Diagnostics& diagnostics);

// Reads what robot.json says of the lights of a panel or strip; nothing for another driver.
[[nodiscard]] std::optional<PanelConfig> read_lights(Fields& fields, vm::DriverId driver,
                                                     Diagnostics& diagnostics);
inline constexpr std::int64_t kUsualPanelPercent = 10;
inline constexpr std::int64_t kMostPanelPercent = 20;
[[nodiscard]] std::vector<std::string_view> panel_colors();

// Reads "pictures": the words of the actuators that show pictures. A word of the device with the same name is replaced.
void read_pictures(const json::Value& value, Robot& robot, Diagnostics& diagnostics);

// Reads the wiring of a differential drive and its measures. nullopt: some are wrong or missing, which is reported.
[[nodiscard]] std::optional<vm::DriveParameters> read_drive(Fields& fields, WiringReader& wiring,
                                                            const ActuatorConfig& actuator,
                                                            Diagnostics& diagnostics);
inline constexpr vm::Value kLeastTrim = 50;  // percent; a larger difference is a fault of the robot

// Reads the encoders of its wheels, if it has any, and how a simulation turns these. If they are wrong, the drive is without.
void read_wheel_encoders(const Fields& fields, std::span<const SensorConfig> sensors,
                         ActuatorConfig& actuator, Diagnostics& diagnostics);
inline constexpr std::int8_t kUsualDifference = 4;  // percent

// Reads what an edge of an encoder is worth, and checks that a board can count its edges at the greatest speed. `channels`: those of
// robot.json, or null.
void scale_encoder(Fields& fields, SensorConfig& sensor, const json::Value* channels,
                   Diagnostics& diagnostics);

// Is `key`, which is not of the wiring, one of this actuator?
[[nodiscard]] bool may_have(const Device& device, std::string_view key);
// Is `key` one of the sensor or actuator whose entry this is? True also if its device is not known.
[[nodiscard]] bool may_have(const Fields& fields, bool is_sensor, std::string_view key);

// The "name" of an entry, checked.
[[nodiscard]] std::optional<Spelled> read_name(Fields& fields, std::string_view what,
                                               Diagnostics& diagnostics);

// The part of the board that the entry's "device" names; null: none.
[[nodiscard]] const Board::Part* find_part(const Fields& fields, const Board& board,
                                           bool is_sensor);
// The type of an entry; a part of the board may leave it out. Reports like read_type().
[[nodiscard]] const WiringType* choose_type(Fields& fields, const Board::Part* part, bool is_sensor,
                                            Diagnostics& diagnostics);

// The device of an entry: the one it names, or else the generic one of its type. Without a type it is virtual. Reports an assumed
// device (N0001) and a device without a driver (W0212). Null if the named device is unknown, which is reported; the rest of the
// entry may fit the device that was meant.
[[nodiscard]] const Device* choose_device(const Fields& fields, const WiringType* type,
                                          const Spelled& name, const Board& board, bool is_sensor,
                                          Diagnostics& diagnostics);
// The replacement for an unknown device.
[[nodiscard]] const Device& virtual_device(bool is_sensor);

}  // namespace robosync::compiler
