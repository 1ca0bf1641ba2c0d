// Puts a response into plain English: one line for each statement, blocks indented.
#pragma once

#include <map>
#include <string>

#include "compiler/syntax/ast.hpp"

namespace robosync::compiler::explain {

// The DEFINEs of a program by their folded names.
using Defines = std::map<std::string, const ast::Define*>;
[[nodiscard]] Defines defines_of(const ast::Tree& program);
[[nodiscard]] std::string folded(std::string_view name);

// "move right_arm quickly".
[[nodiscard]] std::string command(const ast::Command& command);

// Lines that begin with `indent` spaces and a dash.
[[nodiscard]] std::string statements(const ast::Block& block, const Defines& defines,
                                     std::size_t indent);

}  // namespace robosync::compiler::explain
