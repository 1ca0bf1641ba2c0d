// What the Cortex-M4 port asks of the program it is linked into (boards/common/main.cpp and
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

namespace robosync::port::hooks {

// Counts of the clock (clock.hpp) in a tick (kernel::kTick).
extern const std::uint32_t kTickCounts;

// Only where the clock is not SysTick (clock.hpp). All threads wait: after so many counts an interrupt of the lowest priority is to end the core's
// sleep, unless another did before. It is pending then, and never taken: clear_alarm() takes it
// back. The alarm does not repeat itself.
void set_alarm(std::uint32_t counts);
void clear_alarm();

// A thread was stopped by a fault; the others go on. Called from the fault handler or the context
// switch: may signal threads, must be short.
void thread_faulted(kernel::Thread& thread, const link::Fault& fault);

// Nothing can go on: a fault in a handler, in the kernel, or in the safety thread. Must put the
// outputs into their safe state and reset.
[[noreturn]] void fatal_fault(const link::Fault& fault);

}  // namespace robosync::port::hooks
