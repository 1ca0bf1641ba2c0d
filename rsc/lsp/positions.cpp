#include "rsc/lsp/positions.hpp"

#include <algorithm>

#include "compiler/source/utf8.hpp"

namespace robosync::tool::lsp {
namespace {

using compiler::SourceFile;
namespace utf8 = compiler::utf8;

constexpr char32_t kFirstOfTwo = 0x10000;

std::uint32_t units_of(utf8::CodePoint point, Encoding encoding) {
  if (encoding == Encoding::utf8) return point.size;
  return point.value >= kFirstOfTwo ? 2 : 1;
}

}  // namespace

std::uint32_t units_in(std::string_view text, Encoding encoding) {
  if (encoding == Encoding::utf8) return static_cast<std::uint32_t>(text.size());
  std::uint32_t units = 0;
  for (std::size_t at = 0; at < text.size();) {
    const utf8::CodePoint point = utf8::decode(text, at);
    units += units_of(point, encoding);
    at += point.size;
  }
  return units;
}

std::size_t bytes_of(std::string_view line, std::uint32_t units, Encoding encoding) {
  std::size_t at = 0;
  while (at < line.size()) {
    const utf8::CodePoint point = utf8::decode(line, at);
    const std::uint32_t size = units_of(point, encoding);
    if (size > units) break;
    units -= size;
    at += point.size;
  }
  return at;
}

Place place_of(const SourceFile& source, std::uint32_t offset, Encoding encoding) {
  const auto end = static_cast<std::uint32_t>(source.text().size());
  const std::uint32_t place = std::min(offset, end);
  const std::uint32_t line = source.line_of(place);
  const std::uint32_t start = source.line_start(line);
  return {line - 1, units_in(source.text().substr(start, place - start), encoding)};
}

std::uint32_t offset_of(const SourceFile& source, Place place, Encoding encoding) {
  if (place.line >= source.lines()) return static_cast<std::uint32_t>(source.text().size());
  const std::uint32_t line = place.line + 1;
  const std::size_t bytes = bytes_of(source.line(line), place.character, encoding);
  return source.line_start(line) + static_cast<std::uint32_t>(bytes);
}

}  // namespace robosync::tool::lsp
