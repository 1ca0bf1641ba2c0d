// Where the style of RSL begins a line although the grammar does not ask for it, so that no two statements share one.
//
// In front of the words that divide a block (DO, ELSE, OPTION, RESUME, END …), behind ELSE, and in front of the first
// statement behind DO or OPTION, unless it is the only one there and has no block itself. A block of a rule or IF with one
// such statement and nothing else may also stand on one line.
#pragma once

#include <cstdint>
#include <vector>

#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

struct Place {
  bool begins_line = false;
  // Of an END: the word that opens its block. Of a word that opens a block which may stand on one line: its END. Else 0.
  std::uint32_t partner = 0;
};

// One for each token. `tokens` are those that the grammar sees, of a program without mistakes; keywords that are names are
// of the kind NAME.
[[nodiscard]] std::vector<Place> places_of(const Tokens& tokens);

}  // namespace robosync::compiler
