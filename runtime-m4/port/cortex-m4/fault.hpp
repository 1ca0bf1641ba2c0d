// Faults of threads: what stopped one is reported, and the others go on.
#pragma once

#include <cstdint>

namespace robosync::port {

// Set in link::Fault::cause when the fault is a stack that was too small: an unused bit of CFSR,
// which ARMv8-M uses for the same thing (STKOF).
inline constexpr std::uint32_t kCauseStackOverflow = 1U << 20;
// Set when a thread without privileges made a system call that there is not; the address is its
// number. An unused bit as well.
inline constexpr std::uint32_t kCauseNoSuchCall = 1U << 21;
// Set when a thread ran longer than it may (stop_overrun()). Unused as well.
inline constexpr std::uint32_t kCauseOverrun = 1U << 22;

// From now on faults have handlers of their own, and a division by zero is one.
void enable_fault_handlers();

}  // namespace robosync::port
