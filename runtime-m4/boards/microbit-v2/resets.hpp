// The watchdog, and what reset the chip.
//
// The watchdog (WDT) runs on its own oscillator, which is accurate to a few percent. Once started, only a reset stops it. Its
// interrupt comes two counts, 61 us, before the reset and can be masked, so it could do nothing that the reset does not do;
// it is not used. The reset releases all pins.
#pragma once

#include <cstdint>

namespace robosync::boards::microbit {

enum class ChipReset { other, watchdog, lockup };

// Reads and clears the chip's reset flags, which accumulate over resets.
ChipReset take_reset_cause();

// `ms`: time from the last kick to the reset.
void start_watchdog(std::uint32_t ms);
void kick_watchdog();

}  // namespace robosync::boards::microbit
