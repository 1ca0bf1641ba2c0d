// `the` and `an`, as in `MOVE the arms TO 90deg`: RSL has no articles.
#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"
#include "compiler/syntax/vocabulary.hpp"

namespace robosync::compiler {

// Takes them out, and reports all together. A text in which one may be a name keeps them. `robot` may be null.
void leave_out_articles(Tokens& tokens, const SourceFile& source, const Vocabulary* robot,
                        Diagnostics& diagnostics);

}  // namespace robosync::compiler
