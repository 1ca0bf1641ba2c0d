// The one style of RSL: no two statements share a line, blocks are indented, words have one blank or none between them, rows
// of a table are aligned, keywords are in capitals, and items of more than one line have a blank line between them.
//
// Lines are split (breaks.hpp), but never joined; repeated blank lines become one. Words and comments keep their order, so
// the program's meaning stays the same, which is checked.
#pragma once

#include <optional>
#include <string>

#include "compiler/source/source_file.hpp"
#include "compiler/syntax/ast.hpp"

namespace robosync::compiler {

// The formatted text of a program in which parse() finds no mistake; nothing if formatting would change its words. `tree`
// is what parse() returned.
[[nodiscard]] std::optional<std::string> formatted(const SourceMap& sources, FileId file,
                                                   const ast::Tree& tree);

}  // namespace robosync::compiler
