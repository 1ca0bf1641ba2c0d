// Channels by the name a person gives them: "touch.LEVEL", "touch LEVEL", or "touch" when it has
// only one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "vm/image.hpp"

namespace robosync::tool {

// Any case. Throws std::invalid_argument with what is wrong and the nearest name.
[[nodiscard]] std::uint8_t find_channel(const vm::Image& image, std::string_view name);
[[nodiscard]] std::uint8_t find_channel(const vm::Image& image, std::string_view sensor,
                                        std::string_view channel);

// What a channel measures, as a person writes it: "20cm", or the label of a channel with words. A
// channel with two labels takes true and false as well, if it has no labels of these names. Throws
// std::invalid_argument.
[[nodiscard]] vm::Value parse_reading(const vm::Image& image, std::uint8_t channel,
                                      std::string_view text);

}  // namespace robosync::tool
