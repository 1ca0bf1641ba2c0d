// What the Cortex-M4 port needs from the program it is linked into (boards/common/main.cpp and
// boards/NAME/).
#pragma once

#include <cstdint>

#include "link/messages.hpp"

namespace robosync::kernel {
class Kernel;
class Thread;
}  // namespace robosync::kernel

// The one kernel of the firmware.
extern "C" robosync::kernel::Kernel robosync_kernel;

// Only where the idle thread sometimes has work (board_idle in board.cmake). While the first is not 0, the idle thread calls the
// second instead of sleeping. That one may use no stack, because the idle thread's has no room.
extern "C" volatile std::uint32_t robosync_has_work;
extern "C" void robosync_work_instead();

namespace robosync::port::hooks {

// Counts of the clock (clock.hpp) in a tick (kernel::kTick).
extern const std::uint32_t kTickCounts;

// Only where the clock is not SysTick (clock.hpp). All threads are blocked: after `counts`, an
// interrupt of the lowest priority must end the core's sleep, unless another interrupt ends it
// earlier. That interrupt stays pending and is never taken: clear_alarm() clears it. The alarm does
// not repeat.
void set_alarm(std::uint32_t counts);
void clear_alarm();

// A fault has stopped a thread; the others continue. Called from the fault handler or the context
// switch: may signal threads, must be short.
void thread_faulted(kernel::Thread& thread, const link::Fault& fault);

// A fatal fault: in a handler, in the kernel, or in the safety thread. Must put the outputs into their
// safe state and reset.
[[noreturn]] void fatal_fault(const link::Fault& fault);

}  // namespace robosync::port::hooks
