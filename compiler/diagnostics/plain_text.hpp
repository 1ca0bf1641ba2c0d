// Is a file text at all? Editors and word processors save texts in forms that rsc does not read, and some characters show
// a line otherwise than it is read. Each is said once for a file, before anything is read of it.
#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler {

// Reports, as `code`, what is wrong with the file as a text. False when nothing should be read of it: UTF-16, bytes that
// are not UTF-8, a NUL byte, a mark that turns the direction of writing around.
[[nodiscard]] bool is_plain_text(const SourceMap& sources, FileId file, Code code,
                                 Diagnostics& diagnostics);

}  // namespace robosync::compiler
