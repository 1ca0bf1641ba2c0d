// Text to tokens: one call for a whole file. Every end of a line is a token; layout.hpp drops those
// that do not count.
#pragma once

#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// Any bytes are fine: what RSL does not use is reported and left out, or read as what was meant.
// The text must be smaller than 4 GiB.
[[nodiscard]] std::vector<Token> lex(const SourceFile& source, FileId file,
                                     Diagnostics& diagnostics);

}  // namespace robosync::compiler
