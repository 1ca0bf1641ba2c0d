// Prints diagnostics: for people (rustc style, 10-language.md section 5) and as JSON (60-cli.md).
#pragma once

#include <string>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler {

[[nodiscard]] std::string render_human(const Diagnostics& diagnostics, const SourceMap& sources,
                                       bool color);
[[nodiscard]] std::string render_json(const Diagnostics& diagnostics, const SourceMap& sources);

}  // namespace robosync::compiler
