// What a program brings along from the place where it was copied: numbers, bullets or prompts before its lines, and the fences
// around it. Each kind is one error, and left out.
#pragma once

#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// Returns the places that are left out: what the lexer says about them is a part of the error.
[[nodiscard]] std::vector<Span> leave_out_pasted(Tokens& tokens, const SourceFile& source,
                                                 Diagnostics& diagnostics);

}  // namespace robosync::compiler
