// Case folding for ASCII, independent of the locale: RSL's words, units and names ignore case. Bytes above ASCII are
// unchanged.
#pragma once

#include <algorithm>
#include <string_view>

namespace robosync::compiler::ascii {

[[nodiscard]] constexpr char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

[[nodiscard]] constexpr char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

[[nodiscard]] constexpr bool same(char a, char b) {
  return lower(a) == lower(b);
}

[[nodiscard]] constexpr bool is_letter(char c) {
  return 'a' <= lower(c) && lower(c) <= 'z';
}

[[nodiscard]] constexpr bool is_digit(char c) {
  return '0' <= c && c <= '9';
}

// Ignores case.
[[nodiscard]] constexpr bool same(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) { return same(x, y); });
}

// Without the blanks of a line at its start and its end.
[[nodiscard]] constexpr std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\v\f\r";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

}  // namespace robosync::compiler::ascii
