// Finds the elements of an array in a JSON text, because Jansson does not keep positions.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace robosync::tool {

// The byte range of each element of the array under `key` in the top object. `text` is valid
// JSON.
struct TextRange {
  std::size_t begin = 0, end = 0;
};
[[nodiscard]] std::vector<TextRange> array_elements(std::string_view text, std::string_view key);

// The line of a byte, from 1.
[[nodiscard]] std::size_t line_of(std::string_view text, std::size_t at);

}  // namespace robosync::tool
