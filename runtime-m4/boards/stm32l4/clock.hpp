// The core's clock.
#pragma once

namespace robosync::boards::stm32l4 {

// Switches from 4 MHz, the clock after reset, to 80 MHz. False when the PLL does not come up: the chip is broken.
[[nodiscard]] bool start_clock();

}  // namespace robosync::boards::stm32l4
