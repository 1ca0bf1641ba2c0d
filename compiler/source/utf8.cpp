// See utf8.hpp.
#include "compiler/source/utf8.hpp"

#include <algorithm>
#include <array>
#include <iterator>

namespace robosync::compiler::utf8 {

namespace {

struct CodePoints {
  char32_t first, last;
};

template <std::size_t N>
bool contains(const std::array<CodePoints, N>& ranges, char32_t value) {
  return std::any_of(ranges.begin(), ranges.end(), [value](CodePoints range) {
    return range.first <= value && value <= range.last;
  });
}

constexpr std::array<CodePoints, 4> zero_width = {
    {{0x0300, 0x036F}, {0x200B, 0x200D}, {0x20D0, 0x20FF}, {0xFE00, 0xFE0F}}};

constexpr std::array<CodePoints, 8> double_width = {{{0x1100, 0x115F},
                                                     {0x2E80, 0xA4CF},
                                                     {0xAC00, 0xD7A3},
                                                     {0xF900, 0xFAFF},
                                                     {0xFE30, 0xFE6F},
                                                     {0xFF00, 0xFF60},
                                                     {0x1F300, 0x1FAFF},
                                                     {0x20000, 0x3FFFD}}};

// Control characters, and the marks that change the direction of writing ("Trojan Source").
constexpr std::array<CodePoints, 5> unprintable = {
    {{0x00, 0x1F}, {0x7F, 0x9F}, {0x200E, 0x200F}, {0x2028, 0x202E}, {0x2066, 0x2069}}};

// What a lead byte says about its sequence: the size (two or more bytes; 0: not a lead byte), its own bits of the value,
// and the smallest value that may be encoded this way.
struct Lead {
  std::uint8_t size;
  char32_t bits, smallest;
};

Lead classify(unsigned char lead) {
  if (lead >= 0xC2 && lead < 0xE0) return {2, lead & 0x1FU, 0x80};
  if (lead >= 0xE0 && lead < 0xF0) return {3, lead & 0x0FU, 0x800};
  if (lead >= 0xF0 && lead < 0xF5) return {4, lead & 0x07U, 0x10000};
  return {0, 0, 0};
}

}  // namespace

CodePoint decode(std::string_view text, std::size_t offset) {
  const auto first = static_cast<unsigned char>(text[offset]);
  if (first < 0x80) return {first, 1};
  const Lead lead = classify(first);
  if (lead.size == 0 || text.size() - offset < lead.size) return {};
  char32_t value = lead.bits;
  for (std::size_t i = 1; i < lead.size; ++i) {
    const auto byte = static_cast<unsigned char>(text[offset + i]);
    if ((byte & 0xC0U) != 0x80U) return {};
    value = (value << 6U) | (byte & 0x3FU);
  }
  const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
  if (value < lead.smallest || value > 0x10FFFF || surrogate) return {};
  return {value, lead.size};
}

unsigned width(char32_t code_point) {
  if (code_point < 0x300) return 1;
  if (contains(zero_width, code_point)) return 0;
  return contains(double_width, code_point) ? 2 : 1;
}

bool is_printable(char32_t code_point) {
  if (code_point >= 0x20 && code_point < 0x7F) return true;
  return !contains(unprintable, code_point);
}

void append_printable(std::string& result, std::string_view text) {
  constexpr std::string_view mark = "\xEF\xBF\xBD";
  for (std::size_t i = 0; i < text.size();) {
    const CodePoint point = decode(text, i);
    const bool keep = point.value != replacement && is_printable(point.value);
    result += keep ? text.substr(i, point.size) : mark;
    i += point.size;
  }
}

std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  append_printable(result, text);
  return result;
}

}  // namespace robosync::compiler::utf8
