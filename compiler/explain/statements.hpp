// Puts a response into plain English: one line for each statement, blocks indented.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "compiler/syntax/ast.hpp"

namespace robosync::compiler::explain {

// A program and the modules that it uses; the program is the first.
using Trees = std::span<const ast::Tree* const>;

// The DEFINEs of a program by their folded names; of two with one name, the first.
using Defines = std::map<std::string, const ast::Define*>;
[[nodiscard]] Defines defines_of(Trees trees);
[[nodiscard]] std::string folded(std::string_view name);

// "move right_arm quickly".
[[nodiscard]] std::string command(const ast::Command& command);

// Lines that begin with `indent` spaces and a dash.
[[nodiscard]] std::string statements(const ast::Block& block, const Defines& defines,
                                     std::size_t indent);

}  // namespace robosync::compiler::explain
