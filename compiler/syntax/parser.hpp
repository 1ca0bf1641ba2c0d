// Reads RSL text into its tree. Grammar: grammar/rsl.yy (Bison), tokens: grammar/rsl.re (re2c).
#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/ast.hpp"
#include "compiler/syntax/vocabulary.hpp"

namespace robosync::compiler {

// Always returns a tree. Text that cannot be read is left out and reported, with examples that use the names of the robot
// if it is known.
[[nodiscard]] ast::Tree parse(const SourceMap& sources, FileId file, Diagnostics& diagnostics,
                              const Vocabulary* robot = nullptr);

}  // namespace robosync::compiler
