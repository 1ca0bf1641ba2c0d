// Quantities as people write them on the command line and in scenarios: "20cm", "1.5s", "3".
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "vm/image.hpp"

namespace robosync::tool {

// Throws std::invalid_argument with the reason: not a number, no such unit, a unit of another dimension, or none where
// one is needed. `own`: the unit that robot.json or the program uses here, if known; the message suggests it for a
// number without a unit.
[[nodiscard]] vm::Value parse_quantity(std::string_view text, vm::Dimension dimension,
                                       std::string_view own = {});

[[nodiscard]] std::string format_quantity(vm::Value value, vm::Dimension dimension);

// "10s", "250ms"; not negative.
[[nodiscard]] std::chrono::milliseconds parse_duration(std::string_view text);

}  // namespace robosync::tool
