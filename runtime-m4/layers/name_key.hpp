// Names as numbers, so that two programs can be compared without their texts side by side.
#pragma once

#include <cstdint>
#include <string_view>

namespace robosync::layers {

// A CRC-32 of a name, ignoring case, continuing from `seed` (0 to begin).
[[nodiscard]] std::uint32_t name_key(std::string_view name, std::uint32_t seed = 0);

}  // namespace robosync::layers
