// The watchdog, and what reset the chip.
//
// The watchdog (WDT) runs on an oscillator of its own, which is right to some percent, and once started nothing stops it but a
// reset. Its interrupt comes two of its counts, 61 us, before the reset, and can be masked: too late and too weak to do
// something that the reset does not do, so nobody asks for it. The reset lets all pins go.
#pragma once

#include <cstdint>

namespace robosync::boards::microbit {

enum class ChipReset { other, watchdog, lockup };

// What was noted in the chip, which is forgotten there: the next reset adds to it.
ChipReset take_reset_cause();

// `ms`: from the last kick to the reset.
void start_watchdog(std::uint32_t ms);
void kick_watchdog();

}  // namespace robosync::boards::microbit
