// The pictures that lights, displays and panels show (runtime-m4/drivers/pictures.hpp).
#pragma once

#include <optional>

#include "rsc/json.hpp"
#include "rsc/trace/event_reader.hpp"
#include "runtime-m4/drivers/pictures.hpp"

namespace robosync::tool {

// Five rows from the top, with # for each light that is on.
[[nodiscard]] Json rows_of(drivers::Picture lights);
// Does the actuator show them, rather than only report its commands?
[[nodiscard]] bool shows_pictures(const vm::Actuator& actuator);
// The picture that a command for such an actuator shows, if it shows one.
[[nodiscard]] std::optional<drivers::Picture> picture_of(const EventReader& command);

}  // namespace robosync::tool
