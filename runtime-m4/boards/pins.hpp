// What the board that the preset names (ROBOSYNC_BOARD) lets programs do with its pins: from its profile,
// stdlib/boards/NAME.json, as CMake reads it (profile.cmake). It is part of the firmware: no upload changes it.
#pragma once

#include <algorithm>
#include <array>

#include "runtime-m4/policy/pins.hpp"

namespace robosync::boards {

inline constexpr policy::PinLimit kOutputs[] = {ROBOSYNC_OUTPUTS};
inline constexpr policy::PinRange kInputs[] = {ROBOSYNC_INPUTS};
inline constexpr policy::PinRange kEchoes[] = {ROBOSYNC_ECHOES};
inline constexpr std::array<policy::PinRange, ROBOSYNC_ANALOG_ROWS> kAnalog = {{ROBOSYNC_ANALOG}};
inline constexpr std::array<policy::PinRange, ROBOSYNC_ENABLE_ROWS> kEnables = {{ROBOSYNC_ENABLES}};
inline constexpr std::array<policy::PinRange, ROBOSYNC_PANEL_ROWS> kPanels = {{ROBOSYNC_PANELS}};
inline constexpr std::array<policy::I2cPlace, ROBOSYNC_RESERVED_ROWS> kReserved = {
    {ROBOSYNC_RESERVED}};
inline constexpr std::array<policy::PinRange, ROBOSYNC_SPI_PIN_ROWS> kSpiPins = {
    {ROBOSYNC_SPI_PINS}};
inline constexpr std::array<policy::PinRange, ROBOSYNC_SELECT_ROWS> kSelects = {{ROBOSYNC_SELECTS}};
inline constexpr policy::BoardPins kPins = {.outputs = kOutputs,
                                            .inputs = kInputs,
                                            .echoes = kEchoes,
                                            .analog = kAnalog,
                                            .enables = kEnables,
                                            .panels = kPanels,
                                            .i2c_buses = ROBOSYNC_I2C_BUSES,
                                            .reserved = kReserved,
                                            .serial_lines = ROBOSYNC_SERIAL_LINES,
                                            .spi_buses = ROBOSYNC_SPI_BUSES,
                                            .spi_pins = kSpiPins,
                                            .selects = kSelects,
                                            .player_pin = ROBOSYNC_PLAYER_PIN};

constexpr bool meet(const auto& these, const auto& those) {
  for (const auto& one : these)
    for (const auto& other : those)
      if (one.first <= other.last && other.first <= one.last) return true;
  return false;
}
// The pin of an echo is always an input.
static_assert(!meet(kEchoes, kOutputs));
static_assert(ROBOSYNC_SERIAL_LINES <= 1, "the output guard silences one player at a time");
static_assert(!meet(kEnables, kOutputs) && !meet(kEnables, kInputs) && !meet(kEnables, kAnalog));
static_assert(!meet(kSelects, kSpiPins));
constexpr bool is_shared(const policy::PinLimit& output) {
  const std::array one{output};
  return meet(one, kInputs) || meet(one, kAnalog);
}
static_assert(std::ranges::all_of(kOutputs,
                                  [](const auto& output) {
                                    return output.last < policy::kMostShared || !is_shared(output);
                                  }),
              "the output guard has a bit for each output that is an input, too");

}  // namespace robosync::boards
