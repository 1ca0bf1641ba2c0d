// Escapes a text for a format in which some characters have a meaning.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>

namespace robosync::tool {

struct Escape {
  char character;
  std::string_view written;
};

[[nodiscard]] inline std::string escaped(std::string_view text,
                                         std::initializer_list<Escape> escapes) {
  std::string safe;
  for (const char c : text) {
    const auto* const escape = std::ranges::find(escapes, c, &Escape::character);
    safe += escape == escapes.end() ? std::string_view(&c, 1) : escape->written;
  }
  return safe;
}

}  // namespace robosync::tool
