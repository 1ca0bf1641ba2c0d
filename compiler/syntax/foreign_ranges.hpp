// Ranges in a condition as others write them: `IN 2cm TO 5cm`, `FROM 2cm TO 5cm`, `IN [2, 5]`, `IN 2..5`, `IS BETWEEN 2cm, 5cm`.
// Each is one error that shows `IS BETWEEN 2cm AND 5cm`.
#pragma once

#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// Turns their tokens into those of RSL. Returns where they are: what the lexer says about them is a part of the error.
[[nodiscard]] std::vector<Span> mend_foreign_ranges(Tokens& tokens, const SourceFile& source,
                                                    Diagnostics& diagnostics);

}  // namespace robosync::compiler
