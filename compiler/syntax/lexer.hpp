// Text to tokens: one call for a whole file. Every end of a line is a token; layout.hpp drops those
// that do not count.
#pragma once

#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// What is reported of one of these begins so, by which the parser knows the line: what that lacks is a consequence.
inline constexpr std::string_view kStrangeCharacter = "RSL does not use the character ";

// Any bytes are fine: what RSL does not use is reported and left out, or read as what was meant.
// The text must be smaller than 4 GiB.
[[nodiscard]] std::vector<Token> lex(const SourceFile& source, FileId file,
                                     Diagnostics& diagnostics);

}  // namespace robosync::compiler
