// How what has a position moves, and how long that takes: servos, and virtual actuators that move as
// the real one would. No output; a driver adds its own.
//
//   MOVE TO x, MOVE BY x    the way there, at AT, or in OVER
//   MOVE                    a gesture: to the range's end, to its beginning, and back to where
//                           it was
//
// Nothing tells where an actuator stands when a program starts: it is taken to be at rest, which is 0
// or the end of the range next to it. One that is not to move (AT 0) has done so at once. OVER is
// stretched where it would need more than the actuator's speed limit.
#pragma once

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::drivers::way {

inline constexpr kernel::Duration kFrame = kernel::milliseconds(policy::kSetpointPeriodMs);

// It stands at `position` from now on.
void stand(const Device& device, vm::Value position, kernel::Time now);
void stand_at_rest(const Device& device, kernel::Time now);
// It stands where it is, or goes to rest.
void stop(const Device& device, vm::Release how, kernel::Time now);
// Is the order one that says where to?
bool has_target(const Order& order);
vm::Value target_of(const Device& device, const Order& order, kernel::Time now);
// Begins to move; `usual` is its speed where the order says none. False: it is done at once.
[[nodiscard]] bool start(const Device& device, const Order& order, vm::Value usual,
                         kernel::Time now);
// One leg is done: begins the next one. False: there is none.
[[nodiscard]] bool next_leg(const Device& device, kernel::Time now);

}  // namespace robosync::drivers::way
