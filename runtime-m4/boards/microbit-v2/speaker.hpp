// The speaker, on a pin of its own, by the module PWM2. It is silent from start() on.
#pragma once

#include <cstdint>

namespace robosync::boards::microbit::speaker {

void start();
// The tone from now on, in Hz, from 31 on; 0 is silent, at once. Any state of the machine.
void sound(std::uint32_t hertz);

}  // namespace robosync::boards::microbit::speaker
