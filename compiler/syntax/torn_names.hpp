// `my-count`, which is a difference in RSL, and `my count`. If a line declares it, it is one name in the whole text, and one error.
#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// Reports each such name once, and makes it one token wherever it stands.
void mend_torn_names(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics);

}  // namespace robosync::compiler
