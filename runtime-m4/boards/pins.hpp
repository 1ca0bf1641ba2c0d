// What the board that the preset names (ROBOSYNC_BOARD) lets programs do with its pins: its profile,
// stdlib/boards/NAME.json, as CMake reads it (profile.cmake). It is part of the firmware: no upload changes it.
#pragma once

#include "runtime-m4/policy/pins.hpp"

namespace robosync::boards {

inline constexpr policy::PinLimit kOutputs[] = {ROBOSYNC_OUTPUTS};
// On the host, what any board has.
inline constexpr bool kHasLights = ROBOSYNC_LIGHTS != 0;
inline constexpr bool kHasSpeaker = ROBOSYNC_SPEAKER != 0;
inline constexpr policy::PinRange kInputs[] = {ROBOSYNC_INPUTS};
inline constexpr policy::BoardPins kPins = {
    .outputs = kOutputs, .inputs = kInputs, .i2c_buses = ROBOSYNC_I2C_BUSES};

}  // namespace robosync::boards
