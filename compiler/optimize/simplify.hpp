// The same expression with fewer operations, whatever its parts turn out to be.
#pragma once

#include "compiler/sema/program.hpp"

namespace robosync::compiler {

// Unknown stays unknown, and what saturates still does. Facts are not looked at, and those of new
// parts are not filled in.
void simplify(Expression& expression);

// NOT `condition`, simplified.
[[nodiscard]] Expression negated(Expression condition);

}  // namespace robosync::compiler
