// An END or a BEHAVIOR in the head of a BEHAVIOR would close it, or begin another one, too early: every line in it would
// then be a mistake. These functions report it once, before the text is split into items (layout.hpp).
#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"
#include "compiler/syntax/vocabulary.hpp"

namespace robosync::compiler {

// Reports such words and removes them from the tokens.
void mend_heads(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics);

// `REMEMBER end = 0`, `margin BELOW 5` in a CHECK: reports a word of RSL that is declared as a name. The same spelling, in lower
// case, counts as that name everywhere, so that the mistake is reported once.
void mend_names(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics);

// `"name": "when"` in robot.json, which is reported there: reads such a word as that name, but for the first of a line.
void mend_robot_names(Tokens& tokens, const SourceFile& source, const Vocabulary& robot);

// Reports rows of a CHECK, a MOTION or a TEST whose first line is missing, and inserts one.
void mend_lost_heads(Tokens& tokens, Diagnostics& diagnostics);

}  // namespace robosync::compiler
