// Warnings about programs that are correct and yet may not do what was meant.
#pragma once

#include "compiler/sema/names.hpp"
#include "compiler/sema/quantities.hpp"

namespace robosync::compiler {

// W0203: a WHEN/ELSE acts at start. `condition` is its translation; the fix is made from the text
// of the rule.
void lint_start(const ast::Rule& rule, const ast::WhenRule& when, const Names& names,
                const Typed& condition, const SourceMap& sources, Diagnostics& diagnostics);

// W0201: a band that nothing reaches, or values of `input` that no band has.
void lint_bands(const ast::Check& node, const ir::Check& check, const Typed& input,
                Diagnostics& diagnostics);

// What can be said only of a whole program, when it has no errors.
struct LintInput {
  const ast::Tree& tree;  // without its modules: they are not the user's to mend
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
// W0206, W0211: labels that are never entered or left; a DEFINE or LET that nothing uses.
void lint_names(const LintInput& input);
// W0208, W0209, W0218: thresholds on noisy sensors; motion without SAFETY; no rule at all.
void lint_robot(const LintInput& input);

}  // namespace robosync::compiler
