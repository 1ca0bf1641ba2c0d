// See character_names.hpp.
#include "compiler/source/character_names.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "compiler/source/utf8.hpp"

namespace robosync::compiler::utf8 {

namespace {

struct Named {
  char32_t point;
  std::string_view name;
};
constexpr Named kNames[] = {
#define CHARACTER(point, name) {point, name},
#include "compiler/source/character_names.def"
#undef CHARACTER
};

struct Block {
  char32_t first, last;
  std::string_view what;
};
constexpr Block kBlocks[] = {
    {0x0000, 0x001F, "a control character"},
    {0x0080, 0x009F, "a control character"},
    {0x2000, 0x206F, "a punctuation mark"},
    {0x2070, 0x209F, "a small digit"},
    {0x20A0, 0x20CF, "a currency sign"},
    {0x2190, 0x21FF, "an arrow"},
    {0x2200, 0x22FF, "a mathematical sign"},
    {0x2500, 0x25FF, "a drawing character"},
    {0x2600, 0x27BF, "a symbol"},
    {0x2B00, 0x2BFF, "an arrow"},
    {0x3000, 0x303F, "a punctuation mark"},
    {0xE000, 0xF8FF, "a character with no standard meaning"},
    {0xFF00, 0xFF60, "a wide character"},
    {0x1F000, 0x1FAFF, "an emoji"},
};

std::string_view name_of(char32_t point) {
  const auto named = std::ranges::find(kNames, point, &Named::point);
  if (named != std::end(kNames)) return named->name;
  const auto block = std::ranges::find_if(
      kBlocks, [point](const Block& range) { return range.first <= point && point <= range.last; });
  return block != std::end(kBlocks) ? block->what : std::string_view("a character");
}

std::string hexadecimal(char32_t point) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  constexpr std::size_t least = 4;
  std::string text;
  for (auto rest = static_cast<std::uint32_t>(point); rest != 0 || text.size() < least; rest /= 16)
    text.insert(text.begin(), digits[rest % 16]);
  return "U+" + text;
}

void append(std::string& text, char32_t point) {
  const auto byte = [&text](char32_t bits) { text += static_cast<char>(bits); };
  if (point < 0x80) return byte(point);
  if (point < 0x800) {
    byte(0xC0U | point >> 6U);
  } else {
    if (point < 0x10000) {
      byte(0xE0U | point >> 12U);
    } else {
      byte(0xF0U | point >> 18U);
      byte(0x80U | (point >> 12U & 0x3FU));
    }
    byte(0x80U | (point >> 6U & 0x3FU));
  }
  byte(0x80U | (point & 0x3FU));
}

}  // namespace

std::string describe(char32_t code_point) {
  const std::string name(name_of(code_point));
  if (!is_printable(code_point) || width(code_point) == 0)
    return hexadecimal(code_point) + " (" + name + ")";
  std::string text = "`";
  append(text, code_point);
  return text + "` (" + hexadecimal(code_point) + ", " + name + ")";
}

}  // namespace robosync::compiler::utf8
