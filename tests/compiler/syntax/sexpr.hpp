// The tree of a program as an s-expression, for tests. Strings stay in quotes, names do not.
#pragma once

#include <string>

#include "compiler/syntax/ast.hpp"

namespace robosync::compiler::testing {

[[nodiscard]] std::string to_sexpr(const ast::Tree& program);  // one item a line

}  // namespace robosync::compiler::testing
