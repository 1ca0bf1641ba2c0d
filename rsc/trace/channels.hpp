// Finds channels by the name that a person writes: "touch.LEVEL", "touch LEVEL", or "touch" if it
// has only one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/units/units.hpp"
#include "rsc/program.hpp"
#include "vm/image.hpp"

namespace robosync::tool {

// "; did you mean `touch`?", or else "; known: touch, voice" if these are few.
[[nodiscard]] std::string instead_of(std::string_view name, const std::vector<std::string>& known);

// Ignores case. Throws std::invalid_argument with the reason and the nearest name.
[[nodiscard]] std::uint8_t find_channel(const vm::Image& image, std::string_view name);
[[nodiscard]] std::uint8_t find_channel(const vm::Image& image, std::string_view sensor,
                                        std::string_view channel);

struct FoundChannel {
  std::optional<std::uint8_t> read;  // none: the program does not read it, so the image lacks it
  const compiler::Unit* unit = nullptr;  // in robot.json; null: not known
};
// Knows all channels of robot.json. `sensor` may be the whole name, "touch.LEVEL", if `channel` is empty.
[[nodiscard]] FoundChannel find_read_channel(const Program& program, std::string_view sensor,
                                             std::string_view channel);

// The unit of its numbers in robot.json; empty: none, or not known.
[[nodiscard]] std::string_view unit_of(const Program& program, std::uint8_t channel);

// "2000cm is out of the range of proximity DISTANCE, 2cm to 400cm: the robot reads 400cm"; empty: it is in the range.
[[nodiscard]] std::string range_note(const Program& program, std::uint8_t channel, vm::Value value);

// Parses a reading as a person writes it: "20cm", or a label of a channel with words. A channel
// with two labels also takes true and false, unless these are labels. Throws std::invalid_argument,
// which may suggest `unit`, the channel's own.
[[nodiscard]] vm::Value parse_reading(const vm::Image& image, std::uint8_t channel,
                                      std::string_view text, std::string_view unit = {});

}  // namespace robosync::tool
