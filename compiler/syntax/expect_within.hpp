// Steps of a TEST as people say them: `EXPECT SAY "Hello" IN 1s`. RSL says WITHIN, and FOR after NOTHING.
#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// Reports each such step and gives it the right word.
void mend_expectations(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics);

}  // namespace robosync::compiler
