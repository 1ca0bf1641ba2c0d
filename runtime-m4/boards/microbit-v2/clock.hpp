// The clocks: the core's, and TIMER0, which keeps the time and ends the core's sleep.
#pragma once

#include <cstdint>

#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit {

// After reset the chip runs at 64 MHz from an oscillator that may be off by a few percent; from here on it runs from the
// crystal. False when the crystal does not start: the board is broken.
[[nodiscard]] bool start_clock();

// Channels of kClockTimer.
inline constexpr unsigned kAlarm = 0, kReading = 1, kLogoIsEmpty = 2, kLogoIsCharged = 3;

// Counts up, in 1/16 us. [any processor state]
//
// An interrupt between the two lines may read the clock, too, and leave a later count here, which is just as right.
inline std::uint32_t counted() {
  kClockTimer.capture(kReading).write(kDoIt);
  return kClockTimer.value(kReading).read();
}

// TIMER0 requests its interrupt once, after so many counts. True if that time may have passed already, so that it was missed.
[[nodiscard]] bool begin_alarm(std::uint32_t counts);
void end_alarm();

}  // namespace robosync::boards::microbit
