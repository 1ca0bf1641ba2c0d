// Serves the displays of a program, from the thread of each: not from those that say what they shall show, nor from the output
// guard, which never waits for a bus.
#pragma once

#include "runtime-m4/drivers/served.hpp"
#include "runtime-m4/guard/output_guard.hpp"

namespace robosync::drivers {

// One frame of `sensor` of the image, which is an SSD1306 that shall show OutputGuard::picture_on(): what has changed, at most
// policy::kDisplayPortions of 20 bytes, address included, tried twice each. Where nothing has, one portion of a round of all that
// there is to say, so that a display that was disturbed unnoticed is right again after 5 s. False when it has not answered: the
// round begins anew.  [thread of the sensor]
[[nodiscard]] bool serve_ssd1306(const ServedBus& at, guard::OutputGuard& outputs, unsigned sensor);

}  // namespace robosync::drivers
