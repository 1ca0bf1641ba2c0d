// Entries of "sensors" and "actuators" in robot.json (sensors.cpp, actuators.cpp), and what they have in common.
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

// Always gives a usable entry, so that one mistake does not make its name unknown; nothing when it
// has no name.
[[nodiscard]] std::optional<SensorConfig> read_sensor(const json::Value& value,
                                                      WiringReader& wiring,
                                                      Diagnostics& diagnostics);
[[nodiscard]] std::optional<ActuatorConfig> read_actuator(const json::Value& value,
                                                          WiringReader& wiring,
                                                          Diagnostics& diagnostics);

// One channel of a sensor. Overwrites in `channel` what `value` says; the rest stays as the device's descriptor has it.
// `inputs`: how many inputs the device has.
void read_channel(const json::Value& value, unsigned inputs, ChannelConfig& channel,
                  Diagnostics& diagnostics);

// How the lights of a panel lie, and how they are lit.
[[nodiscard]] PanelConfig read_panel(const Fields& fields, Diagnostics& diagnostics);
inline constexpr std::int64_t kUsualPanelPercent = 10;
inline constexpr std::int64_t kMostPanelPercent = 20;
[[nodiscard]] std::vector<std::string_view> panel_colors();
// The keys that say so, which nothing else has.
[[nodiscard]] std::span<const std::string_view> panel_keys();

// The "name" of an entry, checked.
[[nodiscard]] std::optional<Spelled> read_name(Fields& fields, std::string_view what,
                                               Diagnostics& diagnostics);

// Which of the board's own parts an entry means by its "device"; null: none.
[[nodiscard]] const Board::Part* find_part(const Fields& fields, const Board& board,
                                           bool is_sensor);
// Its "type", which for a part need not be said. As read_type().
[[nodiscard]] const WiringType* choose_type(Fields& fields, const Board::Part* part, bool is_sensor,
                                            Diagnostics& diagnostics);

// The device an entry means: the one it names, or the generic one of its type. Says what it assumed
// (N0001) and when there is no driver (W0212). What has no type is virtual. Null: it names one that nobody knows, which is
// said; what else stands in the entry may be right for the one that is meant.
[[nodiscard]] const Device* choose_device(const Fields& fields, const WiringType* type,
                                          const Spelled& name, const Board& board, bool is_sensor,
                                          Diagnostics& diagnostics);
// In place of that one.
[[nodiscard]] const Device& virtual_device(bool is_sensor);

}  // namespace robosync::compiler
