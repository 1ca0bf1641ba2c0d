// Turns a program's command into an order that the actuator may carry out.
#pragma once

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/layers/command_pool.hpp"
#include "runtime-m4/layers/messages.hpp"
#include "vm/image.hpp"

namespace robosync::layers {

// Resolves `command` for the actuator. Its parameters are clamped to the actuator's range (TO) and limits (AT), except those
// of a motion, which have other meanings.
void resolve(const vm::Actuator& actuator, const Command& command, QueuedOrder& queued);

// Clamps the order's own parameters to the actuator's range and limits.
void limit(const vm::Actuator& actuator, drivers::Order& order);

}  // namespace robosync::layers
