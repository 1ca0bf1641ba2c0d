// What a name in a text means, in each program that the text is part of.
#pragma once

#include <optional>
#include <vector>

#include "compiler/query/symbols.hpp"
#include "rsc/lsp/answers.hpp"

namespace robosync::tool::lsp {

struct Meant {
  Asked asked;
  const compiler::query::Occurrence* name = nullptr;  // never null
  const compiler::query::Symbol* symbol = nullptr;    // likewise
};

[[nodiscard]] std::optional<Meant> meant_by(const Asked& asked);
// In every program that the text is part of, as far as the editor has made it known: a robot.json and a module have several.
[[nodiscard]] std::vector<Meant> meant_here(Desk desk, const Json& params);
// For a name that is in robot.json, too: also in all other programs that use this robot.json.
[[nodiscard]] std::vector<Meant> meant_everywhere(Desk desk, const Json& params);

[[nodiscard]] inline const compiler::SourceMap& sources_of(const Asked& asked) {
  return asked.checked->result().sources;
}
// All places of the name in that program.
[[nodiscard]] std::vector<compiler::query::Occurrence> places_of(const Meant& meant);

}  // namespace robosync::tool::lsp
