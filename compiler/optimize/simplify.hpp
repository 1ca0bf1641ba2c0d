// The same expression with fewer operations, whatever its parts turn out to be.
#pragma once

#include "compiler/ir/program.hpp"

namespace robosync::compiler {

// Unknown stays unknown, and what saturates still does. Facts are not looked at, and those of new
// parts are not filled in. Time words are left alone: equal ones in a response share a rule, so to
// make two of them equal would change the numbers of the rules behind.
void simplify(Expression& expression);

// NOT `condition`, simplified.
[[nodiscard]] Expression negated(Expression condition);

}  // namespace robosync::compiler
