// Warnings about programs that are correct but may not do what was meant.
#pragma once

#include "compiler/sema/names.hpp"
#include "compiler/sema/quantities.hpp"

namespace robosync::compiler {

// W0203: a WHEN/ELSE acts at start. `condition` is the translated condition; the fix is built from the text
// of the rule.
void lint_start(const ast::Rule& rule, const ast::WhenRule& when, const Names& names,
                const Typed& condition, const SourceMap& sources, Diagnostics& diagnostics);

// W0201: a band that no value reaches, or values of `input` that are in no band.
void lint_bands(const ast::Check& node, const ir::Check& check, const Typed& input,
                Diagnostics& diagnostics);

// The input of lints that need a whole program without errors.
struct LintInput {
  const ast::Tree& tree;  // without modules, which the user cannot fix
  const ir::Program& program;
  const Robot& robot;
  Names& names;
  Diagnostics& diagnostics;
};
// W0202, W0204, W0207, W0219: rules that never run, COOLDOWNs without effect, WHENs that never end,
// WHILEs that take no time.
void lint_rules(const LintInput& input);
// W0205: a WAIT UNTIL without WITHIN.
void lint_waits(const LintInput& input);
// W0206, W0211: labels that are never entered or left; a REMEMBER that nothing sets; a DEFINE, LET or signal that nothing uses.
void lint_names(const LintInput& input);
// W0208, W0209, W0218: thresholds on noisy sensors; motion without SAFETY; no rule at all.
void lint_robot(const LintInput& input);

}  // namespace robosync::compiler
