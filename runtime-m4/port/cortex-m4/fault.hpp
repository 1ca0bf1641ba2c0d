// Faults of threads: a thread that faults is stopped and reported, and the others continue.
#pragma once

#include <cstdint>

namespace robosync::port {

// Set in link::Fault::cause after a stack overflow: an unused bit of CFSR, which ARMv8-M uses for the
// same purpose (STKOF).
inline constexpr std::uint32_t kCauseStackOverflow = 1U << 20;
// Set when an unprivileged thread made a system call that does not exist; link::Fault::address is the
// number of the call. Also an unused bit.
inline constexpr std::uint32_t kCauseNoSuchCall = 1U << 21;
// Set when a thread ran longer than it may (stop_overrun()). Also an unused bit.
inline constexpr std::uint32_t kCauseOverrun = 1U << 22;

// Enables the separate fault handlers, and makes a division by zero a fault.
void enable_fault_handlers();

}  // namespace robosync::port
