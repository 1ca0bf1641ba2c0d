// Whether a name may be changed, and where it then must be.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/query/symbols.hpp"

namespace robosync::compiler::query {

// Why this name cannot be changed in the program `file`; empty: it can be.
[[nodiscard]] std::string why_not_renamed(const Symbol& symbol, FileId file,
                                          const SourceMap& sources);

// Why it cannot be called this; empty: it can be.
[[nodiscard]] std::string why_not_called(std::string_view name, const Symbol& symbol,
                                         const Project& project, const Symbols& symbols);

}  // namespace robosync::compiler::query
