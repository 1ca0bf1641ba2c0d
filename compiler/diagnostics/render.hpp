// Prints diagnostics: for people (as rustc does) and as JSON.
#pragma once

#include <string>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler {

[[nodiscard]] std::string render_human(const Diagnostics& diagnostics, const SourceMap& sources,
                                       bool color);
[[nodiscard]] std::string render_json(const Diagnostics& diagnostics, const SourceMap& sources);

}  // namespace robosync::compiler
