// System calls arrive here: SVC of a thread without privileges. Handler mode, at the kernel's own
// priority, so that no Lock is needed.
//
// Nothing is believed: number and argument are numbers, and the frame they come in was stacked by
// the core with the rights of the thread, so it lies where the thread may write.
#include <cstdint>

#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/fault.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"

extern "C" void SVC_Handler();

// Only the vector table of threads without privileges has it.
void SVC_Handler() {
  using namespace robosync::port;
  CoreFrame* frame = nullptr;
  asm volatile("mrs %0, psp" : "=r"(frame));
  if (!robosync_kernel.answer(frame->r0, frame->r1, frame->r0)) [[unlikely]]
    refuse_call();
}
