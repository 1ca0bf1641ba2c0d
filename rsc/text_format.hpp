// Programs and robot.json in the standard style: for `rsc fmt` and for editors.
#pragma once

#include <optional>
#include <string>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::tool {

// Nothing if the text has errors, which are in `diagnostics` then, or if formatting would change its meaning.
[[nodiscard]] std::optional<std::string> formatted(const compiler::SourceMap& sources,
                                                   compiler::FileId file,
                                                   compiler::Diagnostics& diagnostics);

}  // namespace robosync::tool
