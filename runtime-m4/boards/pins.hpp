// What the board that the preset names (ROBOSYNC_BOARD) lets programs do with its pins: from its profile,
// stdlib/boards/NAME.json, as CMake reads it (profile.cmake). It is part of the firmware: no upload changes it.
#pragma once

#include <algorithm>
#include <array>

#include "runtime-m4/policy/pins.hpp"

namespace robosync::boards {

inline constexpr policy::PinLimit kOutputs[] = {ROBOSYNC_OUTPUTS};
inline constexpr policy::PinRange kInputs[] = {ROBOSYNC_INPUTS};
inline constexpr std::array<policy::PinRange, ROBOSYNC_ANALOG_ROWS> kAnalog = {{ROBOSYNC_ANALOG}};
inline constexpr std::array<policy::PinRange, ROBOSYNC_ENABLE_ROWS> kEnables = {{ROBOSYNC_ENABLES}};
inline constexpr std::array<policy::PinRange, ROBOSYNC_PANEL_ROWS> kPanels = {{ROBOSYNC_PANELS}};
inline constexpr std::array<policy::I2cPlace, ROBOSYNC_RESERVED_ROWS> kReserved = {
    {ROBOSYNC_RESERVED}};
inline constexpr policy::BoardPins kPins = {.outputs = kOutputs,
                                            .inputs = kInputs,
                                            .analog = kAnalog,
                                            .enables = kEnables,
                                            .panels = kPanels,
                                            .i2c_buses = ROBOSYNC_I2C_BUSES,
                                            .reserved = kReserved,
                                            .serial_lines = ROBOSYNC_SERIAL_LINES};

// Nothing drives a pin that is read. Only an analog input may be an output for other programs.
constexpr bool meet(const auto& these, const auto& those) {
  for (const auto& one : these)
    for (const auto& other : those)
      if (one.first <= other.last && other.first <= one.last) return true;
  return false;
}
static_assert(!meet(kInputs, kOutputs) && !meet(kInputs, kAnalog));
static_assert(ROBOSYNC_SERIAL_LINES <= 1, "the output guard silences one player at a time");
static_assert(!meet(kEnables, kOutputs) && !meet(kEnables, kInputs) && !meet(kEnables, kAnalog));
static_assert(std::ranges::all_of(kAnalog, [](const auto& range) { return range.last < 64; }),
              "the output guard has a bit for each");

}  // namespace robosync::boards
