// Blocks in one line with several habits of other languages, such as `if (x > 3) { y = 5; }` and `IF x > 3 THEN y = 5`. Each is
// one error that shows the whole line as RSL writes it.
#pragma once

#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// Turns their tokens into those of RSL. Returns where they are; `said`, what the lexer says about them, is a part of the error.
[[nodiscard]] std::vector<Span> mend_one_line_blocks(Tokens& tokens, const SourceFile& source,
                                                     const Diagnostics& said,
                                                     Diagnostics& diagnostics);

}  // namespace robosync::compiler
