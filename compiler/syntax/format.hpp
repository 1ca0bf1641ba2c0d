// The one style of RSL: blocks are indented, words have one blank or none between them, rows of a table are aligned.
//
// Lines and words stay as they are: only the space between them changes, and repeated blank lines become one. The
// program's meaning stays the same, which is checked.
#pragma once

#include <optional>
#include <string>

#include "compiler/source/source_file.hpp"

namespace robosync::compiler {

// The formatted text of a program in which parse() finds no mistake; nothing if formatting would change its words.
[[nodiscard]] std::optional<std::string> formatted(const SourceMap& sources, FileId file);

}  // namespace robosync::compiler
