// Puts a whole program into plain English: its variables, checks, safety rules, behaviours and DEFINEs, and what interrupts what.
#pragma once

#include <string>

#include "compiler/config/robot.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/ast.hpp"

namespace robosync::compiler::explain {

// `program` may have mistakes; unreadable parts are left out. `robot` may be null: then groups of actuators are unknown, and
// conflicts are found by name only.
[[nodiscard]] std::string program_text(const ast::Tree& program, const SourceMap& sources,
                                       const Robot* robot);

}  // namespace robosync::compiler::explain
