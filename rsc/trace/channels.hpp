// Channels by the name a person gives them: "touch.LEVEL", "touch LEVEL", or "touch" when it has
// only one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "rsc/program.hpp"
#include "vm/image.hpp"

namespace robosync::tool {

// Any case. Throws std::invalid_argument with what is wrong and the nearest name.
[[nodiscard]] std::uint8_t find_channel(const vm::Image& image, std::string_view name);
[[nodiscard]] std::uint8_t find_channel(const vm::Image& image, std::string_view sensor,
                                        std::string_view channel);

// Nothing: robot.json has the channel, and the program does not read it, so that its image does not
// have it. `sensor` may be its whole name, "touch.LEVEL", where `channel` is empty.
[[nodiscard]] std::optional<std::uint8_t> find_read_channel(const Program& program,
                                                            std::string_view sensor,
                                                            std::string_view channel);

// The unit of its numbers in robot.json; empty: it has none, or that is not known.
[[nodiscard]] std::string_view unit_of(const Program& program, std::uint8_t channel);

// What a channel measures, as a person writes it: "20cm", or the label of a channel with words. A
// channel with two labels takes true and false as well, if it has no labels of these names. Throws
// std::invalid_argument, which may offer `unit`, the channel's own.
[[nodiscard]] vm::Value parse_reading(const vm::Image& image, std::uint8_t channel,
                                      std::string_view text, std::string_view unit = {});

}  // namespace robosync::tool
