// The system calls, for unprivileged threads. calls.def lists them, port::call() makes them, and
// Kernel::answer() handles them.
//
// Nothing here touches the kernel's memory, which an unprivileged thread cannot access.
#pragma once

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::kernel::calls {

// Like Kernel::wait(mask).  [unprivileged thread]
inline Events wait(Kernel& kernel, Events mask) {
  return port::call(kernel, static_cast<std::uint32_t>(Call::wait), mask);
}

// Reports that the thread has done the work it was woken for.  [unprivileged thread]
inline void report(Kernel& kernel) {
  port::call(kernel, static_cast<std::uint32_t>(Call::report), 0);
}

// Reports that the work is done, and blocks until the thread is woken again. For a thread that does
// not need to know which event woke it, and is not signalled before it reports.
// [unprivileged thread]
inline void rest(Kernel& kernel, Events mask) {
  port::call(kernel, static_cast<std::uint32_t>(Call::rest), mask);
}

}  // namespace robosync::kernel::calls
