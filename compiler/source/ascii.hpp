// Letters of ASCII, whatever the locale of the computer: RSL's words, units and names are the same in any case. Bytes
// above ASCII are themselves.
#pragma once

#include <algorithm>
#include <string_view>

namespace robosync::compiler::ascii {

[[nodiscard]] constexpr char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

[[nodiscard]] constexpr bool same(char a, char b) {
  return lower(a) == lower(b);
}

[[nodiscard]] constexpr bool is_letter(char c) {
  return 'a' <= lower(c) && lower(c) <= 'z';
}

// In any case.
[[nodiscard]] constexpr bool same(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) { return same(x, y); });
}

}  // namespace robosync::compiler::ascii
