// The one style of RSL: indentation by blocks, one blank or none between words, rows of a table one below the other.
//
// Lines stay lines, and words stay words: only what stands between them changes, and blank lines beyond one. So a
// program means the same, which is checked.
#pragma once

#include <optional>
#include <string>

#include "compiler/source/source_file.hpp"

namespace robosync::compiler {

// The text of a program that parse() finds no mistake in; nothing when that cannot be done without changing it.
[[nodiscard]] std::optional<std::string> formatted(const SourceMap& sources, FileId file);

}  // namespace robosync::compiler
