// The logo, which feels a finger: a touch adds to its capacitance, and so to the time in which the board's resistor of 10 MΩ
// charges it. Hardware takes that time; nothing waits.
#pragma once

#include <cstdint>

namespace robosync::boards::microbit::logo {

void start();
// Takes turns: begins a measurement, or ends it. `raw` is 1 if the last measurement was of a touched logo, else 0. False before
// the first one. A measurement that is ended early, or whose pin stays low, is of a touched logo. [one thread at a time]
[[nodiscard]] bool measure(std::int32_t& raw);

}  // namespace robosync::boards::microbit::logo
