// Words of other languages that people speak: `WENN touch LEVEL < 3 DANN`. They are reported once in a file, and read as those of
// RSL that they mean (foreign_words.def).
#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"
#include "compiler/syntax/vocabulary.hpp"

namespace robosync::compiler {

// `robot` may be null.
void mend_foreign_words(Tokens& tokens, const SourceFile& source, const Vocabulary* robot,
                        Diagnostics& diagnostics);

}  // namespace robosync::compiler
