// Finds a SAFETY rule again in another program, from what an image says about it: images have no names of SAFETY rules.
#pragma once

#include <cstdint>

#include "vm/image.hpp"

namespace robosync::safety {

// From the operations of the rule's condition, the names of the inputs that it reads, and the names of the actuators that the
// rule halts. Numbers are left out: with another limit or another time it is still the same rule. So are the places of inputs
// and actuators, which change when something is added to the program. `rule` is a SAFETY rule of a verified image.
[[nodiscard]] std::uint32_t rule_key(const vm::Image& image, const vm::Rule& rule);

}  // namespace robosync::safety
