// The clocks: that of the core, and TIMER0, which says the time and ends the core's sleep.
#pragma once

#include <cstdint>

#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit {

// The chip comes out of reset with 64 MHz by an oscillator that may be wrong by some percent; from here on the crystal says
// how long a second is. False when it does not begin to swing, which is a broken board.
[[nodiscard]] bool start_clock();

// Counts of 1/16 us, up. Any state of the machine.
//
// Who interrupts between the two lines reads the clock too, and leaves a later count here: that is as true.
inline std::uint32_t counted() {
  timer::kReading.capture().write(kDoIt);
  return timer::kReading.value().read();
}

// After so many counts TIMER0 asks for its interrupt, once. True when that may be over by now, and so was missed.
[[nodiscard]] bool begin_alarm(std::uint32_t counts);
void end_alarm();

}  // namespace robosync::boards::microbit
