// The speaker, on its own pin, driven by the module PWM2. start() leaves it silent.
#pragma once

#include <cstdint>

namespace robosync::boards::microbit::speaker {

void start();
// Plays a tone of at least 31 Hz; 0 is silent immediately. [any processor state]
void sound(std::uint32_t hertz);

}  // namespace robosync::boards::microbit::speaker
