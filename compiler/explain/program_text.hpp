// A whole program in plain English: what it remembers, its checks, safety rules, behaviours and
// DEFINEs, and what interrupts what. So are the modules that it uses, but for what it does not use of them.
#pragma once

#include <string>

#include "compiler/config/robot.hpp"
#include "compiler/explain/statements.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler::explain {

// `trees`, of which there is one at least, may have mistakes; what could not be read is not told. `robot` may be null: then
// groups of actuators are not known, and conflicts are found by name only.
[[nodiscard]] std::string program_text(Trees trees, const SourceMap& sources, const Robot* robot);

}  // namespace robosync::compiler::explain
