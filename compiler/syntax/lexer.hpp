// Turns text into tokens, a whole file per call. Every line end is a token; layout.hpp drops those
// that do not count.
#pragma once

#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// Messages about such a character begin with this. The parser finds the line by it: anything missing there is a consequence.
inline constexpr std::string_view kStrangeCharacter = "RSL does not use the character ";

// Accepts any bytes. Characters that RSL does not use are reported, and left out or read as what was meant.
// The text must be smaller than 4 GiB.
[[nodiscard]] std::vector<Token> lex(const SourceFile& source, FileId file,
                                     Diagnostics& diagnostics);

}  // namespace robosync::compiler
