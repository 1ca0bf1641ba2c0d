// The SPI bus for parts, on SPI1 and two channels of DMA1, at 625 kHz (wiring::kSpi). A panel of lights needs SPI1, too.
#pragma once

#include "runtime-m4/boards/common/asked_spi.hpp"

namespace robosync::boards::stm32l4 {

struct SpiMaster;
using PartBus = AskedSpi<SpiMaster>;

// All its pins for pulses are low, or return to their timers; until it is opened again after start-up. [any processor state]
void switch_spi_off();

}  // namespace robosync::boards::stm32l4

extern template class robosync::boards::AskedSpi<robosync::boards::stm32l4::SpiMaster>;
