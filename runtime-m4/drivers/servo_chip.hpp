// Serves the servo chips of a program, from the thread of each: not from those that move the servos, nor from the output guard,
// which never waits for a bus.
#pragma once

#include "runtime-m4/drivers/served.hpp"
#include "runtime-m4/guard/output_guard.hpp"

namespace robosync::drivers {

// One frame of `sensor` of the image, which is a PCA9685: is it as it was set up? What pulses does it lack? False when it has not
// answered; where that leaves its pulses in doubt, its outputs are off. At most 17 transfers of 3 bytes or less, or 7 of 5,
// three times each.  [thread of the sensor]
[[nodiscard]] bool serve_pca9685(const ServedBus& bus, guard::OutputGuard& outputs,
                                 unsigned sensor);

}  // namespace robosync::drivers
