// From what a program says to what an actuator may do.
#pragma once

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/layers/messages.hpp"
#include "vm/image.hpp"

namespace robosync::layers {

// The parameters of `command`, inside the actuator's range (TO) and limits (AT). False: one of them is kUnknown, and
// nobody can say what the order means. It is not carried out.
[[nodiscard]] bool resolve(const vm::Actuator& actuator, const Command& command,
                           drivers::Order& order);

// The order's own parameters inside the actuator's range and limits.
void limit(const vm::Actuator& actuator, drivers::Order& order);

// The value of a parameter inside the actuator's range (TO) and limits (AT); kUnknown stays.
[[nodiscard]] vm::Value limited(const vm::Actuator& actuator, vm::Param param, vm::Value value);

}  // namespace robosync::layers
