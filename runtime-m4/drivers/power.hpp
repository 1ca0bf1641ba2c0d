// How power goes to a level: immediately, or evenly in OVER. With FOR it goes off afterwards; without, it stays. A driver adds
// the level of the order, and the output.
#pragma once

#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers::power {

inline constexpr vm::Value kFull = 100 * vm::kScale;  // percent
// Thousandths of a percent in a microsecond of the 20 ms frame.
inline constexpr vm::Value kStep = kFull / 20'000;

// Begins to go to `level`; STOP switches off immediately.
void begin(const Device& device, const Order& order, vm::Value level, kernel::Time now);
// When to be called again, or kDone. From now on `motion` gives the level.
[[nodiscard]] kernel::Time advance(const Device& device, kernel::Time now);
// Stays at the level, or goes off.
void stop(const Device& device, vm::Release how, kernel::Time now);

}  // namespace robosync::drivers::power
