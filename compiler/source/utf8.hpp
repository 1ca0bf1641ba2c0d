// UTF-8, one code point at a time. Sources come from outside, so any bytes are accepted: what is
// not valid UTF-8 counts as one replacement character a byte.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace robosync::compiler::utf8 {

inline constexpr char32_t replacement = 0xFFFD;
// What editors on Windows, and Excel, write in front of a text.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view without_byte_order_mark(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return text;
}

struct CodePoint {
  char32_t value = replacement;
  std::uint8_t size = 1;  // bytes it takes in the text
};

// The code point that starts at `offset`, which must be inside the text.
[[nodiscard]] CodePoint decode(std::string_view text, std::size_t offset);

// Columns it takes on a terminal: 0, 1 or 2.
[[nodiscard]] unsigned width(char32_t code_point);

// False for what could move the cursor, hide text or turn its direction around.
[[nodiscard]] bool is_printable(char32_t code_point);

// The text with everything that is not printable replaced.
[[nodiscard]] std::string printable(std::string_view text);
void append_printable(std::string& result, std::string_view text);  // likewise

}  // namespace robosync::compiler::utf8
