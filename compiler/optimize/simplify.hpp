// Rewrites an expression with fewer operations, whatever the values of its parts.
#pragma once

#include "compiler/ir/program.hpp"

namespace robosync::compiler {

// Unknown stays unknown, and saturation is preserved. Facts are not used, and new parts have none. Time words are left alone:
// equal ones in a response share a rule, so making two of them equal would change the numbers of later rules.
void simplify(Expression& expression);

// NOT `condition`, simplified.
[[nodiscard]] Expression negated(Expression condition);

}  // namespace robosync::compiler
