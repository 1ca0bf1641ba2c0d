// What the board that the preset names (ROBOSYNC_BOARD) has for programs: its profile,
// stdlib/boards/NAME.json, as CMake reads it (profile.cmake). The firmware is built and linked by
// it, and on the host it is the board that is simulated when nobody says another.
#pragma once

#include "runtime-m4/policy/memory.hpp"

namespace robosync::boards {

inline constexpr policy::BoardMemory kMemory = {.arena_begin = ROBOSYNC_ARENA_BEGIN,
                                                .arena_bytes = ROBOSYNC_ARENA_BYTES,
                                                .step_budget = ROBOSYNC_STEP_BUDGET};

}  // namespace robosync::boards
