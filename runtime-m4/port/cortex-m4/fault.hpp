// Faults of threads: what stopped one is reported, and the others go on.
#pragma once

#include <cstdint>

namespace robosync::port {

// Set in link::Fault::cause when the fault is a stack that was too small: an unused bit of CFSR,
// which ARMv8-M uses for the same thing (STKOF).
inline constexpr std::uint32_t kCauseStackOverflow = 1U << 20;

// From now on faults have handlers of their own, and a division by zero is one.
void enable_fault_handlers();

}  // namespace robosync::port
