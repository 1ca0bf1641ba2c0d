// Continues after a mistake: finds the smallest change to the tokens that lets the grammar continue,
// reports it, and makes it (after Burke and Fisher, "A practical method for LR and LL syntactic
// error diagnosis and recovery", 1987). The user reads what to change; the rest is parsed
// as if it had been changed, so one mistake gives one message.
#pragma once

#include <cstddef>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/examples.hpp"
#include "compiler/syntax/reader.hpp"

namespace robosync::compiler {

// The number of tokens that the search for repairs may still look at in a whole file: text from outside
// must not keep the compiler busy.
struct Budget {
  std::size_t work = 400'000;
  // Takes `tokens` from the budget; if it has fewer, takes all and returns false.
  bool spend(std::size_t tokens) {
    const bool enough = tokens <= work;
    work = enough ? work - tokens : 0;
    return enough;
  }
};

// Repairs and reports the mistake that stopped the grammar. The grammar usually gets farther then; the caller must check
// that it keeps advancing. When the budget is used up, leaves out the rest of the line.
void mend(Tokens& tokens, const Attempt& failure, Reader& reader, const Examples& examples,
          Diagnostics& diagnostics, Budget& budget);

}  // namespace robosync::compiler
