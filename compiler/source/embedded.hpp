// Texts that the compiler and the tool carry so that they need no other files. cmake/pack.cmake packs those of each list together.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace robosync::compiler {

// What gzip has packed; `size`: how long it was before.
[[nodiscard]] std::string unpacked(std::span<const unsigned char> packed, std::size_t size);

// One text of a list.
struct EmbeddedText {
  const std::string& (*list)();  // all of them, one after the other; unpacked by the first call
  std::size_t at, size;

  [[nodiscard]] std::string_view text() const { return std::string_view(list()).substr(at, size); }
};

}  // namespace robosync::compiler
