// Formats diagnostics for people (as rustc does) and as JSON.
#pragma once

#include <cstddef>
#include <string>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler {

// Further errors are only counted: nobody reads them before fixing the first ones.
inline constexpr std::size_t kMostErrors = 20;

[[nodiscard]] std::string render_human(const Diagnostics& diagnostics, const SourceMap& sources,
                                       bool color, std::size_t most_errors = kMostErrors);
[[nodiscard]] std::string render_json(const Diagnostics& diagnostics, const SourceMap& sources);

}  // namespace robosync::compiler
