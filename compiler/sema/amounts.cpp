// Numbers that some word of the language asks for: their dimension, and what must be known now.
#include "compiler/sema/expressions.hpp"

namespace robosync::compiler {
namespace {

void report_amount(const Typed& number, const Wanted& wanted, Diagnostics& diagnostics) {
  Diagnostic& d =
      diagnostics
          .report(Code::E0301, "`" + wanted.source + "` is " +
                                   std::string(dimension_phrase(wanted.unit->dimension)) +
                                   ", and this is " +
                                   std::string(dimension_phrase(number.dimension())))
          .label(number.digits.empty() ? number.span : number.unit_span);
  if (number.digits.empty()) return;
  const std::string mended = number.digits + std::string(wanted.unit->spelling);
  d.helps("did you mean `" + mended + "`?").fix(number.span, mended);
}

}  // namespace

Typed Expressions::amount(const ast::Expr& expr, const Wanted& wanted) {
  Typed result = number(expr);
  if (!result.is_number()) return make_nothing(expr.span);
  if (result.is_bare()) take_unit(result, wanted, diagnostics_);
  if (!result.is_number()) return make_nothing(expr.span);
  if (result.dimension() != wanted.unit->dimension) {
    report_amount(result, wanted, diagnostics_);
    return make_nothing(expr.span);
  }
  if (wanted.difference) make_difference(result);
  return result;
}

std::optional<Typed> Expressions::constant(const ast::Expr& expr, std::string_view what) {
  Typed result = number(expr);
  if (!result.is_number()) return std::nullopt;
  if (result.is_constant()) return result;
  diagnostics_.report(Code::E0305, std::string(what) + " must be known before the program runs")
      .label(expr.span)
      .helps("write a number, or the name of a LET");
  return std::nullopt;
}

std::optional<Typed> Expressions::constant_amount(const ast::Expr& expr, const Wanted& wanted) {
  Typed result = amount(expr, wanted);
  if (!result.is_number()) return std::nullopt;
  if (result.is_constant()) return result;
  diagnostics_.report(Code::E0305, "this must be known before the program runs")
      .label(expr.span)
      .helps("write a number, or the name of a LET");
  return std::nullopt;
}

Typed Expressions::duration(const ast::Expr& expr, std::string_view what) {
  Typed result =
      amount(expr, {&canonical_unit(vm::Dimension::duration), std::string(what), expr.span});
  if (!result.is_number() || result.high > 0) return result;
  diagnostics_.report(Code::E0509, std::string(what) + " must be above 0").label(expr.span);
  return make_nothing(expr.span);
}

std::optional<vm::Value> Expressions::constant_duration(const ast::Expr& expr,
                                                        std::string_view what) {
  const Typed result = duration(expr, what);
  if (!result.is_number()) return std::nullopt;
  if (result.is_constant()) return result.code.constant;
  diagnostics_
      .report(Code::E0305, "`" + std::string(what) + "` must be known before the program runs")
      .label(expr.span)
      .helps("write a number, or the name of a LET");
  return std::nullopt;
}

}  // namespace robosync::compiler
