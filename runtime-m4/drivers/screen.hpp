// Serves the displays of a program, each from its own thread: not from the threads that say what to show, nor from the output
// guard, which never waits for a bus.
#pragma once

#include "runtime-m4/drivers/served.hpp"
#include "runtime-m4/guard/output_guard.hpp"

namespace robosync::drivers {

// One frame of `sensor` of the image, an SSD1306 that must show OutputGuard::picture_on(). Sends what has changed: at most
// policy::kDisplayPortions of 20 bytes, address included, each tried twice. If nothing has changed, sends one portion of a full
// refresh, so that a display that was disturbed unnoticed is right again after 5 s. False if it did not answer: the
// refresh starts over.  [thread of the sensor]
[[nodiscard]] bool serve_ssd1306(const ServedBus& at, guard::OutputGuard& outputs, unsigned sensor);

}  // namespace robosync::drivers
