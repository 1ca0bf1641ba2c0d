// `SAY Hello!`, `SAY I'm fine`, `SAY Hello, friend`: what is said lacks its quotes.
#pragma once

#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"
#include "compiler/syntax/vocabulary.hpp"

namespace robosync::compiler {

// Makes it a text. Returns where they are: what the lexer says about the signs in them is a part of the error. `robot` may be
// null.
[[nodiscard]] std::vector<Span> mend_spoken_words(Tokens& tokens, const SourceFile& source,
                                                  const Vocabulary* robot,
                                                  Diagnostics& diagnostics);

}  // namespace robosync::compiler
