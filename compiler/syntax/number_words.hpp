// Numbers in words, `3 TIMES` as `THREE TIMES` or `TWICE`, `2s` as `two seconds`. RSL has digits.
#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// Reports each and makes it a number.
void mend_number_words(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics);

}  // namespace robosync::compiler
