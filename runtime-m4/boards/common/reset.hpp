// Why the firmware started, and its last words: kept in memory that survives a reset. They are read and
// cleared when the firmware starts.
#pragma once

#include <cstdint>

#include "link/messages.hpp"

namespace robosync::boards {

using link::ResetReason;

ResetReason last_reset();
// The fault that made the firmware reset itself before this start, or null.
const link::Fault* last_fault();

// Records that the watchdog is about to reset the board. Legal in an NMI.
void keep_watchdog_reset();
// Switches the outputs off, keeps `fault` for the next start and resets.
[[noreturn]] void reset_after(const link::Fault& fault);

}  // namespace robosync::boards
