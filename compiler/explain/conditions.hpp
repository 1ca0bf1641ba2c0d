// Puts conditions and numbers of the tree into plain English. "When" alone is ambiguous to some readers, so a rule says "as soon
// as … becomes true" or "while … is true".
#pragma once

#include <string>

#include "compiler/syntax/ast.hpp"

namespace robosync::compiler::explain {

// "visitors + 1", "a random number from 1 to 6".
[[nodiscard]] std::string number(const ast::Expr& expr);

// "touch LEVEL is less than 3"; with several parts: "touch LEVEL is more than 0 and …".
[[nodiscard]] std::string is_true(const ast::Expr& condition);

// "As soon as touch LEVEL becomes less than 3".
[[nodiscard]] std::string as_soon_as(const ast::Expr& condition);
// "While touch LEVEL is less than 3".
[[nodiscard]] std::string while_true(const ast::Expr& condition);

}  // namespace robosync::compiler::explain
