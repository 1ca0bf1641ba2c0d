// How power goes to a level: at once, or evenly in OVER; with FOR it goes off after that, without it stays. A driver adds
// what the order's level is, and how it is put out.
#pragma once

#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers::power {

inline constexpr vm::Value kFull = 100 * vm::kScale;  // percent
// Thousandths of a percent in a microsecond of the 20 ms frame.
inline constexpr vm::Value kStep = kFull / 20'000;

// Begins to go to `level`; STOP is off at once.
void begin(const Device& device, const Order& order, vm::Value level, kernel::Time now);
// When to look again, or kDone. The level is the motion's from now on.
[[nodiscard]] kernel::Time advance(const Device& device, kernel::Time now);
// Stays at the level, or is off.
void stop(const Device& device, vm::Release how, kernel::Time now);

}  // namespace robosync::drivers::power
