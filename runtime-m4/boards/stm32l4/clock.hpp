// The clock of the core.
#pragma once

namespace robosync::boards::stm32l4 {

// The chip comes out of reset with 4 MHz; from here on it has 80. False when the PLL does not come up, which is a
// broken chip.
[[nodiscard]] bool start_clock();

}  // namespace robosync::boards::stm32l4
