// The temperature of the chip, by TEMP. A measurement takes 36 us, in the background.
#pragma once

#include <cstdint>

namespace robosync::boards::microbit::thermometer {

// The result of the measurement that the last call began, in quarters of a degree; false if there is none. Begins the next one.
[[nodiscard]] bool measure(std::int32_t& raw);

}  // namespace robosync::boards::microbit::thermometer
