// How much a lint (W0201 …) counts: as robot.json says, above that the command line, and above that a comment in front of
// the line that it is about: `# allow W0203: the first reading shall choose`.
#pragma once

#include <map>

#include "compiler/config/robot.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler {

struct LintLevels {
  std::map<Code, LintLevel> levels;
  bool deny_warnings = false;  // whatever is a warning after that is an error
};

// Drops the lints that are allowed, and sets the level of those that have another one than usual.
void apply_lints(Diagnostics& diagnostics, const SourceMap& sources, const Robot* robot,
                 const LintLevels& asked);

}  // namespace robosync::compiler
