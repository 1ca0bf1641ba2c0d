// `the` and `an`, as in `MOVE the arms TO 90deg`: RSL has no articles.
#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// Takes them out, and reports all together. A text in which one is a name keeps them.
void leave_out_articles(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics);

}  // namespace robosync::compiler
