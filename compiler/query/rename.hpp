// Tells whether a name may be changed, and to what.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/query/symbols.hpp"

namespace robosync::compiler::query {

// Why the name cannot be changed in the program `file`; empty: it can.
[[nodiscard]] std::string why_not_renamed(const Symbol& symbol, FileId file,
                                          const SourceMap& sources);

// Why the symbol cannot get this name; empty: it can.
[[nodiscard]] std::string why_not_called(std::string_view name, const Symbol& symbol,
                                         const Project& project, const Symbols& symbols);

}  // namespace robosync::compiler::query
