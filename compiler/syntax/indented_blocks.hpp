// Blocks in the form of other programming languages: a line that ends with a colon begins one, which continues as far as it is
// indented; an IF outside of all blocks, without a DO, is a rule. They are reported once in a file, and get the words that RSL has.
#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

void mend_indented_blocks(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics);

}  // namespace robosync::compiler
