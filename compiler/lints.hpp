// The level of a lint (W0201 …). robot.json sets it; the command line overrides that; a comment above the reported line
// overrides both: `# allow W0203: the first reading shall choose`.
#pragma once

#include <map>

#include "compiler/config/robot.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler {

struct LintLevels {
  std::map<Code, LintLevel> levels;
  bool deny_warnings = false;  // after that, turns every remaining warning into an error
};

// Drops the allowed lints and sets the level of those that are configured.
void apply_lints(Diagnostics& diagnostics, const SourceMap& sources, const Robot* robot,
                 const LintLevels& asked);

}  // namespace robosync::compiler
