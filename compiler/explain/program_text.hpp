// Puts a whole program into plain English: its variables, checks, safety rules, behaviours and DEFINEs, and what interrupts what.
// The modules that it uses are included, without the DEFINEs that it does not use.
#pragma once

#include <string>

#include "compiler/config/robot.hpp"
#include "compiler/explain/statements.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler::explain {

// `trees`: at least one; they may have mistakes, and unreadable parts are left out. `robot` may be null: then groups of actuators
// are unknown, and conflicts are found by name only.
[[nodiscard]] std::string program_text(Trees trees, const SourceMap& sources, const Robot* robot);

}  // namespace robosync::compiler::explain
