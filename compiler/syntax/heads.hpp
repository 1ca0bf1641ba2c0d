// An END or a BEHAVIOR in the head of a BEHAVIOR would close it, or begin another one, before it has begun: then every line
// of it would be a mistake. It is said here once, before the text is split into items (layout.hpp).
#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// Reports such words, and takes them out of the tokens.
void mend_heads(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics);

// `REMEMBER end = 0`: reports a word of RSL that is declared as a name. Where it is written the same way again, in small
// letters, the name is meant: so that it is said once.
void mend_names(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics);

// Rows of a CHECK, a MOTION or a TEST that have lost their first line: reports it, and puts one there.
void mend_lost_heads(Tokens& tokens, Diagnostics& diagnostics);

}  // namespace robosync::compiler
