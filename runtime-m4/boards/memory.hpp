// The memory for programs on the board that the preset names (ROBOSYNC_BOARD): from its profile,
// stdlib/boards/NAME.json, as CMake reads it (profile.cmake). The firmware is built and linked with
// these values; on the host, this is the board that is simulated by default.
#pragma once

#include "runtime-m4/policy/memory.hpp"

namespace robosync::boards {

inline constexpr policy::BoardMemory kMemory = {.arena_begin = ROBOSYNC_ARENA_BEGIN,
                                                .arena_bytes = ROBOSYNC_ARENA_BYTES,
                                                .step_budget = ROBOSYNC_STEP_BUDGET};

}  // namespace robosync::boards
