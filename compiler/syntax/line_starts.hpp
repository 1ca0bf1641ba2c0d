// Lines of RSL that begin in a wrong way: `PRIORITY 5 BEHAVIOR greet`, `AT 10s DO`, `GIVEN touch LEVEL = 5`. Each is one error.
#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// Reports such lines, and turns their tokens into those of RSL.
void mend_line_starts(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics);

}  // namespace robosync::compiler
