// Serves the servo chips of a program, each from its own thread: not from the threads that move the servos, nor from the output
// guard, which never waits for a bus.
#pragma once

#include "runtime-m4/drivers/served.hpp"
#include "runtime-m4/guard/output_guard.hpp"

namespace robosync::drivers {

// One frame of `sensor` of the image, a PCA9685: checks that it is still set up, and sends the pulses that it lacks. False if it
// did not answer; if that leaves its pulses in doubt, its outputs are off. At most 17 transfers of 3 bytes or less, or 7 of 5,
// three times each.  [thread of the sensor]
[[nodiscard]] bool serve_pca9685(const ServedBus& bus, guard::OutputGuard& outputs,
                                 unsigned sensor);

}  // namespace robosync::drivers
