// Parses a line of a module's program as a reading of the robot (docs/companion.md).
#pragma once

#include <optional>
#include <string_view>

#include "vm/image.hpp"

namespace robosync::tool {

struct Said {
  std::string_view output, value;
};

// "WORD hello". Nothing: the line is not a reading.
[[nodiscard]] std::optional<Said> parse_said(std::string_view line);

// A word of the channel, or a decimal number in the canonical unit within its range. Nothing: neither.
[[nodiscard]] std::optional<vm::Value> parse_value(const vm::Image& image,
                                                   const vm::Channel& channel,
                                                   std::string_view text);

}  // namespace robosync::tool
