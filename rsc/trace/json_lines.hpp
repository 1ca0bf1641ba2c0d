// Where in a JSON text the elements of an array stand; Jansson keeps no places after parsing.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace robosync::tool {

// Byte range of each element of the array that is the value of `key` in the top object. `text` is
// valid JSON.
struct TextRange {
  std::size_t begin = 0, end = 0;
};
[[nodiscard]] std::vector<TextRange> array_elements(std::string_view text, std::string_view key);

// Line of a byte, from 1.
[[nodiscard]] std::size_t line_of(std::string_view text, std::size_t at);

}  // namespace robosync::tool
