// `STOP arms WHEN x > 3` in a block: the condition stands behind its command.
#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// Reports such a line, which is not empty and in a block, and returns its tokens in the order of RSL; nothing for any other line.
[[nodiscard]] Tokens condition_first(const Tokens& tokens, TokenRange line,
                                     const SourceFile& source, Diagnostics& diagnostics);

}  // namespace robosync::compiler
