// Goes on after a mistake: finds the smallest change to the tokens with which the grammar can go
// on, reports it, and makes it (after Burke and Fisher, "A practical method for LR and LL syntactic
// error diagnosis and recovery", 1987). The user reads what to change; the next mistake is judged
// as if it had been changed. That is why one mistake gives one message.
#pragma once

#include <cstddef>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/examples.hpp"
#include "compiler/syntax/reader.hpp"

namespace robosync::compiler {

// Tokens that may still be looked at in the search for mends, for a whole file: text from outside
// shall not keep the compiler busy.
struct Budget {
  std::size_t work = 400'000;
  // Takes `tokens` of it; takes all and gives false when that is not enough.
  bool spend(std::size_t tokens) {
    const bool enough = tokens <= work;
    work = enough ? work - tokens : 0;
    return enough;
  }
};

// Mends and reports the mistake that stopped the grammar. Mostly the grammar gets farther then; that it does, again and
// again, is for the caller to see. When the budget is used up
// it takes the first change that comes to hand.
void mend(Tokens& tokens, const Attempt& failure, Reader& reader, const Examples& examples,
          Diagnostics& diagnostics, Budget& budget);

}  // namespace robosync::compiler
