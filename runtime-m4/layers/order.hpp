// From what a program says to what an actuator may do.
#pragma once

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/layers/command_pool.hpp"
#include "runtime-m4/layers/messages.hpp"
#include "vm/image.hpp"

namespace robosync::layers {

// `command` for the actuator: its parameters inside the actuator's range (TO) and limits (AT), but for those of a motion,
// whose parameters are others.
void resolve(const vm::Actuator& actuator, const Command& command, QueuedOrder& queued);

// The order's own parameters inside the actuator's range and limits.
void limit(const vm::Actuator& actuator, drivers::Order& order);

}  // namespace robosync::layers
