// Tells whether a name may be changed, and to what.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/query/symbols.hpp"

namespace robosync::compiler::query {

// Why the name cannot be changed; empty: it can.
[[nodiscard]] std::string why_not_renamed(const Symbol& symbol, const SourceMap& sources);

// Why the symbol cannot get this name; empty: it can.
[[nodiscard]] std::string why_not_called(std::string_view name, const Symbol& symbol,
                                         const Project& project, const Symbols& symbols);

// If `text` says both a sensor and its channel, of which `renamed` is one: the text when that is called `name`, written as it was.
// `meant`: what it means. `touchLevel` becomes `handLevel` or `touchForce`.
[[nodiscard]] std::optional<std::string> joined_name(std::string_view text, const Symbol& meant,
                                                     const Symbol& renamed, std::string_view name,
                                                     const Project& project);

// Why the program is another one after a name was changed, in which each name must mean what it meant before; empty: it is the same.
[[nodiscard]] std::string why_not_same(const Symbols& before, const Diagnostics& said_before,
                                       const Symbols& after, const Diagnostics& said_after);

}  // namespace robosync::compiler::query
