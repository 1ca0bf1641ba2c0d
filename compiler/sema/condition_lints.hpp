// Warnings about single conditions, found while they are translated: conditions that never change, and momentary
// events that are tested for lasting.
#pragma once

#include "compiler/sema/names.hpp"
#include "compiler/sema/quantities.hpp"

namespace robosync::compiler {

// True for a random value: it is drawn anew each time, so it is not even equal to itself.
[[nodiscard]] bool draws(const Expression& expression);

// W0210: the ranges of the sides decide the comparison.
void lint_comparison(ast::Relation relation, const Typed& left, const Typed& right, Span span,
                     Diagnostics& diagnostics);
// The same of `value IS BETWEEN low AND high`.
void lint_between(const Typed& value, const Typed& low, const Typed& high, Span span,
                  Diagnostics& diagnostics);
// Two sides of an AND that exclude each other, or of an OR that cover every value.
void lint_logic(ast::LogicOp op, const Expression& left, const Expression& right, Span span,
                Names& names, Diagnostics& diagnostics);
// A comparison that stays true for ever because of its MARGIN.
void lint_margin(ast::Relation relation, const Typed& left, const Typed& right, const Typed& margin,
                 Diagnostics& diagnostics);
// … and an IS BETWEEN.
void lint_margin(const Typed& value, const Typed& low, const Typed& high, const Typed& margin,
                 Diagnostics& diagnostics);
// A step of CHANGES BY that is wider than the number's range.
void lint_step(const Typed& value, const Typed& by, Diagnostics& diagnostics);

// W0220: FOR, or a WHILE rule, on a condition that is true only for a moment.
void lint_held(const ast::Expr& condition, const Expression& code, Diagnostics& diagnostics);
void lint_while(const ast::Rule& rule, const ast::Expr& condition, const Expression& code,
                Diagnostics& diagnostics);
// The same for a WHEN with ELSE. True if it has warned.
bool lint_sides(const ast::Expr& condition, const Expression& code, Diagnostics& diagnostics);

}  // namespace robosync::compiler
