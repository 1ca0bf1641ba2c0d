// System calls, as a thread without privileges makes them. The list: calls.def. What they do:
// Kernel::answer(). How they get there: port::call().
//
// Nothing here touches the kernel's memory, which such a thread has no access to.
#pragma once

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::kernel::calls {

// As Kernel::wait(mask).  [a thread without privileges]
inline Events wait(Kernel& kernel, Events mask) {
  return port::call(kernel, static_cast<std::uint32_t>(Call::wait), mask);
}

// Says that it has done what it was woken for.  [a thread without privileges]
inline void report(Kernel& kernel) {
  port::call(kernel, static_cast<std::uint32_t>(Call::report), 0);
}

// Says that it has done what it was woken for, and waits to be woken again: for a thread that knows
// by itself what for, and is not signalled before it has said so.  [a thread without privileges]
inline void rest(Kernel& kernel, Events mask) {
  port::call(kernel, static_cast<std::uint32_t>(Call::rest), mask);
}

}  // namespace robosync::kernel::calls
