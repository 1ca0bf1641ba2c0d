// The SPI bus for parts: pins 13 (clock), 14 (data from the part) and 15 (data to it) of the edge connector, on SPIM3, at 1 MHz.
// While it is open, the sound player's line, which is pin 15, is closed.
#pragma once

#include "runtime-m4/boards/common/asked_spi.hpp"

namespace robosync::boards::microbit {

struct SpiMaster;
using PartBus = AskedSpi<SpiMaster>;

// The bus no longer drives its pins, until it is opened again after start-up. [any processor state]
void switch_spi_off();

}  // namespace robosync::boards::microbit

extern template class robosync::boards::AskedSpi<robosync::boards::microbit::SpiMaster>;
