// The pictures that lights, displays and panels show (runtime-m4/drivers/pictures.def).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "rsc/trace/event_reader.hpp"

namespace robosync::tool {

// Five rows from the top, with # for each light that is on.
using Picture = std::array<std::string_view, 5>;

[[nodiscard]] std::span<const Picture> pictures();
// Does the actuator show them, rather than only report its commands?
[[nodiscard]] bool shows_pictures(const vm::Actuator& actuator);
// The index of the picture in a command for such an actuator, if it shows one.
[[nodiscard]] std::optional<std::size_t> picture_of(const EventReader& command);

}  // namespace robosync::tool
