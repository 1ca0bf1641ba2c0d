// The board's buses. Their code is on the way of each sample, so this file is compiled for speed.
#include "runtime-m4/boards/microbit-v2/board.hpp"

template class robosync::boards::AskingBoard<robosync::boards::microbit::Buses>;

extern "C" {

void EdgeBus_Handler();
void OwnBus_Handler();

void EdgeBus_Handler() {
  robosync::boards::microbit::board.i2c(0).on_interrupt();
}

void OwnBus_Handler() {
  robosync::boards::microbit::board.i2c(1).on_interrupt();
}

}  // extern "C"
