// Places as editors count them: lines from 0, and characters of a line in the units that were agreed on, of which UTF-16
// counts two for what is outside the first 65,536 code points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "compiler/source/source_file.hpp"

namespace robosync::tool::lsp {

enum class Encoding : std::uint8_t { utf8, utf16 };

struct Place {
  std::uint32_t line = 0;
  std::uint32_t character = 0;
};

// Units of a piece of text.
[[nodiscard]] std::uint32_t units_in(std::string_view text, Encoding encoding);
// Bytes of the first so many units of a line: at most all of it. A place inside of a code point is that before it.
[[nodiscard]] std::size_t bytes_of(std::string_view line, std::uint32_t units, Encoding encoding);

[[nodiscard]] Place place_of(const compiler::SourceFile& source, std::uint32_t offset,
                             Encoding encoding);
// Behind the end of a line: its end. Behind the last line: the end of the text.
[[nodiscard]] std::uint32_t offset_of(const compiler::SourceFile& source, Place place,
                                      Encoding encoding);

}  // namespace robosync::tool::lsp
