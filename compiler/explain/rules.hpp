// Puts rules into plain English: when they start, what they do, what their modifiers mean.
#pragma once

#include <string>
#include <string_view>

#include "compiler/explain/statements.hpp"
#include "compiler/syntax/ast.hpp"

namespace robosync::compiler::explain {

// Whole lines, indented by `indent`. `place` says where the rule is: "line 3".
[[nodiscard]] std::string rule_text(const ast::Rule& rule, std::string_view place,
                                    const Defines& defines, std::size_t indent);

// Without its title.
[[nodiscard]] std::string safety_text(const ast::Safety& safety, const Defines& defines,
                                      std::size_t indent);

}  // namespace robosync::compiler::explain
