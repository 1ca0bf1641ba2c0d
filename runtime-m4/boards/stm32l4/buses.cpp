// The board's buses. Their code is on the way of each sample, so this file is compiled for speed.
#include "runtime-m4/boards/stm32l4/board.hpp"

template class robosync::boards::AskingBoard<robosync::boards::stm32l4::Buses>;

extern "C" {

void HeaderBus_Handler();
void OwnBus_Handler();

void HeaderBus_Handler() {
  robosync::boards::stm32l4::board.i2c(0).on_interrupt();
}

// For the last bus. A board with one bus has no vector for this.
void OwnBus_Handler() {
  using namespace robosync::boards::stm32l4;
  board.i2c(wiring::kBuses.size() - 1).on_interrupt();
}

}  // extern "C"
