// The board's buses. Their code is on the way of each sample, and of each bit, so this file is compiled for speed.
#include "runtime-m4/boards/mps2-an386/board.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"

template class robosync::boards::AskingBoard<robosync::boards::mps2::Buses>;

extern "C" {

void Timer0_Handler();

// The kernel's tests have their own.
[[gnu::weak]] void Timer0_Handler() {
  robosync::boards::mps2::board.i2c(0).on_interrupt();
}

void robosync_work_instead() {
  robosync::boards::mps2::LineMaster::hurry();
}

}  // extern "C"
