// Warnings about single conditions, while they are translated: those that never change, and moments that are
// asked whether they last.
#pragma once

#include "compiler/sema/names.hpp"
#include "compiler/sema/quantities.hpp"

namespace robosync::compiler {

// W0210: what the sides can be decides the comparison.
void lint_comparison(ast::Relation relation, const Typed& left, const Typed& right, Span span,
                     Diagnostics& diagnostics);
// The same of `value IS BETWEEN low AND high`.
void lint_between(const Typed& value, const Typed& low, const Typed& high, Span span,
                  Diagnostics& diagnostics);
// Two sides of an AND that exclude each other, or of an OR that leave nothing out.
void lint_logic(ast::LogicOp op, const Expression& left, const Expression& right, Span span,
                Names& names, Diagnostics& diagnostics);
// A comparison that its MARGIN never lets go of.
void lint_margin(ast::Relation relation, const Typed& left, const Typed& right, const Typed& margin,
                 Diagnostics& diagnostics);
// A step of CHANGES BY that is wider than what the number can be.
void lint_step(const Typed& value, const Typed& by, Diagnostics& diagnostics);

// W0220: FOR, or WHILE with its rule, of what is true for a moment only.
void lint_held(const ast::Expr& condition, const Expression& code, Diagnostics& diagnostics);
void lint_while(const ast::Rule& rule, const ast::Expr& condition, const Expression& code,
                Diagnostics& diagnostics);

}  // namespace robosync::compiler
