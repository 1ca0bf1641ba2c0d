// How actuators with a position move, and how long that takes: servos, and virtual actuators that move
// like the real ones. No output; a driver adds its own.
//
//   MOVE TO x, MOVE BY x    the way there, at AT, or in OVER
//   MOVE                    a gesture: to the range's end, to its beginning, and back to where
//                           it was
//
// Nothing reports where an actuator is when a program starts: it is assumed to be at rest, which is 0
// or the end of the range next to 0. An actuator that must not move (AT 0) is done immediately. OVER is
// stretched if it would need more than the actuator's limits.
//
// With a limit of acceleration a movement is a trapezoid (trapezoid.hpp). One that replaces a movement under way goes on at the
// present speed if its target lies ahead, far enough to stop there, and its own speed is no less. Otherwise the actuator
// brakes first. So it does for a gesture, and for stop.
#pragma once

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::drivers::way {

inline constexpr kernel::Duration kFrame = kernel::milliseconds(policy::kSetpointPeriodMs);

// From now on it stands at `position`.
void stand(const Device& device, vm::Value position, kernel::Time now);
void stand_at_rest(const Device& device, kernel::Time now);
// Where it is now: on a ramp, or …
vm::Value position_on_ramps(const ActuatorState& state, kernel::Time now);
// … in any case. Inlined: without ramps it costs a branch.
[[gnu::always_inline]] inline vm::Value position(const Device& device, kernel::Time now) {
  const ActuatorState& state = device.state;
  return state.ramp == 0 ? state.motion.at(now) : position_on_ramps(state, now);
}
// Stays where it is, or goes to rest, at once.
void stop(const Device& device, vm::Release how, kernel::Time now);
// Begins to slow down to a standstill. False: it is done immediately, because it has no limit of acceleration or does not move.
[[nodiscard]] bool brake(const Device& device, kernel::Time now);
// Does the order say where to go?
bool has_target(const Order& order);
vm::Value target_of(const Device& device, const Order& order, kernel::Time now);
// Begins to move; `usual` is the speed if the order gives none. False: it is done immediately.
[[nodiscard]] bool start(const Device& device, const Order& order, vm::Value usual,
                         kernel::Time now);
// A leg is done: begins the next one. False: there is none.
[[nodiscard]] bool next_leg(const Device& device, kernel::Time now);

}  // namespace robosync::drivers::way
