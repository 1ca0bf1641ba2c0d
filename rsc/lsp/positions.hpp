// Positions as editors count them: lines from 0, and characters in the negotiated unit. UTF-16 counts two for code
// points above 65,535.
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

// The length of a text in units.
[[nodiscard]] std::uint32_t units_in(std::string_view text, Encoding encoding);
// The byte offset of a unit in a line, at most its length. A position inside a code point becomes the one before it.
[[nodiscard]] std::size_t bytes_of(std::string_view line, std::uint32_t units, Encoding encoding);

[[nodiscard]] Place place_of(const compiler::SourceFile& source, std::uint32_t offset,
                             Encoding encoding);
// Beyond the end of a line: its end. Beyond the last line: the end of the text.
[[nodiscard]] std::uint32_t offset_of(const compiler::SourceFile& source, Place place,
                                      Encoding encoding);

}  // namespace robosync::tool::lsp
