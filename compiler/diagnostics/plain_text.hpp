// Checks that a file is plain text. Editors and word processors save text in forms that rsc does not read, and some
// characters make a line look different from how rsc reads it. Each is reported once per file, before parsing.
#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler {

// Reports, as `code`, what is wrong with the file as text. False when the file should not be parsed: UTF-16, bytes that
// are not UTF-8, a NUL byte, or a mark that changes the direction of writing.
[[nodiscard]] bool is_plain_text(const SourceMap& sources, FileId file, Code code,
                                 Diagnostics& diagnostics);

}  // namespace robosync::compiler
