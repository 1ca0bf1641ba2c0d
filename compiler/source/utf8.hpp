// UTF-8, one code point at a time. Sources come from outside, so any bytes are accepted: each invalid
// byte counts as one replacement character.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace robosync::compiler::utf8 {

inline constexpr char32_t replacement = 0xFFFD;
// Excel and editors on Windows write it at the start of a file.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view without_byte_order_mark(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return text;
}

struct CodePoint {
  char32_t value = replacement;
  std::uint8_t size = 1;  // in bytes
};

// The code point that starts at `offset`, which must be inside the text.
[[nodiscard]] CodePoint decode(std::string_view text, std::size_t offset);

// The columns it takes on a terminal: 0, 1 or 2.
[[nodiscard]] unsigned width(char32_t code_point);

// False for characters that could move the cursor, hide text or reverse its direction.
[[nodiscard]] bool is_printable(char32_t code_point);

// The text with all unprintable characters replaced.
[[nodiscard]] std::string printable(std::string_view text);
void append_printable(std::string& result, std::string_view text);  // the same, appended

}  // namespace robosync::compiler::utf8
