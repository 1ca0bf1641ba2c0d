// Lines of other languages, such as `servo.write(90);` or a whole function of Python or C++. They are reported once in a file,
// with what to write in RSL, and left out: whatever else is wrong in them is a consequence.
#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"
#include "compiler/syntax/vocabulary.hpp"

namespace robosync::compiler {

// The tokens of the text without such lines; in a block of RSL, a statement that does nothing takes their place. What the lexer
// says about them is left out, too. `robot` may be null.
[[nodiscard]] Tokens lex_but_foreign_text(const SourceFile& source, FileId file,
                                          const Vocabulary* robot, Diagnostics& diagnostics);

}  // namespace robosync::compiler
