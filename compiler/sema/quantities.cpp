#include "compiler/sema/quantities.hpp"

#include <fmt/format.h>

namespace robosync::compiler {
namespace {

// "compares {} with {}" with its two places filled in.
std::string fill_in(std::string_view pattern, std::string_view first, std::string_view second) {
  std::string text(pattern);
  text.replace(text.find("{}"), 2, first);
  text.replace(text.find("{}"), 2, second);
  return text;
}

// A literal comes first, because the user can change it.
bool is_literal(const Typed& side) {
  return !side.digits.empty();
}

void label_side(Diagnostic& diagnostic, const Typed& side, bool primary) {
  const std::string phrase(dimension_phrase(side.dimension()));
  if (side.source.empty()) {
    diagnostic.label(side.digits.empty() ? side.span : side.unit_span, phrase, primary);
    return;
  }
  diagnostic.label(side.span, phrase, primary);
  const std::string gives = side.unit->spelling.empty()
                                ? "gives a plain number"
                                : "is in " + std::string(side.unit->spelling);
  diagnostic.label(side.unit_span, "`" + side.source + "` " + gives, false);
}

// Suggests the literal with a unit of the other side's dimension.
void suggest_units(Diagnostic& diagnostic, const Typed& literal, const Typed& other) {
  if (literal.digits.empty() || other.unit == nullptr) return;
  const std::string first = literal.digits + std::string(other.unit->spelling);
  std::string list = "`" + first + "`";
  for (const Unit& unit : units())
    if (unit.dimension == other.dimension() && &unit != other.unit)
      list += ", `" + literal.digits + std::string(unit.spelling) + "`";
  diagnostic.helps("did you mean " + list + "?").fix(literal.span, first, Applicability::likely);
}

}  // namespace

Typed make_constant(vm::Value value, const Unit& unit, Span span) {
  Typed number;
  number.type = Type::number;
  number.code.constant = value;
  number.span = span;
  number.unit = &unit;
  number.unit_span = span;
  number.low = value;
  number.high = value;
  return number;
}

Typed make_nothing(Span span) {
  Typed result;
  result.span = span;
  return result;
}

Typed make_condition(Expression code, Span span) {
  Typed result;
  result.type = Type::condition;
  result.code = std::move(code);
  result.span = span;
  return result;
}

Expression make_constant_code(vm::Value value) {
  Expression result;
  result.constant = value;
  return result;
}

Expression make_local(std::size_t number) {
  Expression result;
  result.operation = Operation::local;
  result.index = number;
  return result;
}

Expression make_unary(Operation operation, Expression operand) {
  Expression result;
  result.operation = operation;
  result.operands.push_back(std::move(operand));
  return result;
}

Expression make_binary(Operation operation, Expression left, Expression right) {
  Expression result = make_unary(operation, std::move(left));
  result.operands.push_back(std::move(right));
  return result;
}

void note_rounded(Decimal number, vm::Value value, const Unit& unit, Span span,
                  Diagnostics& diagnostics) {
  if (!is_rounded(number, unit)) return;
  diagnostics.report(Code::N0005, "the robot stores this as " + format_value(value, unit))
      .label(span, "finer than the robot can store");
}

void take_unit(Typed& number, const Wanted& wanted, Diagnostics& diagnostics) {
  const Unit& unit = wanted.difference ? difference_unit(*wanted.unit) : *wanted.unit;
  const auto value = to_value(number.bare, unit);
  if (!value) {
    const std::string digits = number.digits.empty() ? written(number.bare) : number.digits;
    diagnostics.report(Code::E0304, no_room_for(digits, unit)).label(number.span);
    number.type = Type::nothing;
    return;
  }
  if (wanted.unit->dimension != vm::Dimension::number && !wanted.source.empty())
    diagnostics
        .report(Code::N0002,
                "this is read as " + format_value(*value, unit) + ", the unit of " + wanted.source)
        .label(number.span);
  note_rounded(number.bare, *value, unit, number.span, diagnostics);
  number.unit = &unit;
  number.code.constant = *value;
  number.low = *value;
  number.high = *value;
}

bool unify(Typed& left, Typed& right, std::string_view doing, bool difference,
           Diagnostics& diagnostics) {
  if (left.is_bare() && right.is_bare()) return true;
  if (left.is_bare())
    take_unit(left, {right.unit, right.source, right.unit_span, difference}, diagnostics);
  else if (right.is_bare())
    take_unit(right, {left.unit, left.source, left.unit_span, difference}, diagnostics);
  if (!left.is_number() || !right.is_number()) return false;
  if (left.dimension() == right.dimension())
    return difference || unify_scales(left, right, doing, diagnostics);
  const bool left_first = is_literal(left);
  suggest_units(report_mismatch(left, right, doing, diagnostics), left_first ? left : right,
                left_first ? right : left);
  return false;
}

Diagnostic& report_mismatch(const Typed& left, const Typed& right, std::string_view doing,
                            Diagnostics& diagnostics) {
  Diagnostic& d = diagnostics.report(Code::E0301, fill_in(doing, dimension_phrase(left.dimension()),
                                                          dimension_phrase(right.dimension())));
  const bool left_first = is_literal(left);
  label_side(d, left_first ? left : right, true);
  label_side(d, left_first ? right : left, false);
  return d;
}

void help_with_unit(Diagnostic& diagnostic, const Typed& number, const Unit& wanted) {
  const bool from_number = number.dimension() == vm::Dimension::number;
  const bool to_number = wanted.dimension == vm::Dimension::number;
  if (!number.digits.empty() || number.unit == nullptr || from_number == to_number) return;
  const bool is_source = number.source.size() == number.span.end - number.span.begin;
  const std::string value = is_source ? number.source : "(…)";
  if (from_number)
    diagnostic.helps(fmt::format("multiplied by a unit, a number becomes {}: `{} * 1{}`",
                                 dimension_phrase(wanted.dimension), value, wanted.spelling));
  else if (number.dimension() == vm::Dimension::duration)
    diagnostic.helps(
        fmt::format("divided by a unit, it becomes a number: `{0} / 1s` counts "
                    "seconds, and `{0} / 100ms` tenths of them",
                    value));
  else
    diagnostic.helps(fmt::format("divided by a unit, it becomes a number: `{} / 1{}`", value,
                                 number.unit->spelling));
}

void make_difference(Typed& number) {
  if (!is_point(number) || !is_literal(number) || !number.is_constant()) return;
  number.unit = &difference_unit(*number.unit);
  const vm::Value value = to_value(number.bare, *number.unit).value_or(number.code.constant);
  number.code.constant = value;
  number.low = value;
  number.high = value;
}

// ---- temperatures in F: their scale has an offset, which a difference of two of them does not have

bool is_point(const Typed& number) {
  return number.is_number() && number.unit != nullptr && number.unit->offset != 0;
}

bool is_difference(const Typed& number) {
  return number.is_number() && number.unit != nullptr && is_of_differences(*number.unit);
}

bool report_point(const Typed& number, Diagnostics& diagnostics) {
  if (!is_point(number)) return false;
  const std::string unit(number.unit->spelling);
  diagnostics.report(Code::E0301, "RSL cannot calculate this with a temperature in `" + unit + "`")
      .label(number.span)
      .helps("compare it, or add and subtract a difference such as `5" + unit +
             "`; to calculate, measure in `C` (Celsius)");
  return true;
}

namespace {

void report_scales(const Typed& number, const std::string& message, Diagnostics& diagnostics) {
  diagnostics.report(Code::E0301, message)
      .label(number.span)
      .helps("measure in `C` (Celsius), where both are the same");
}

const Unit* report_sum(const Typed& left, const Typed& right, std::string_view doing,
                       Diagnostics& diagnostics) {
  const auto phrase = [](const Typed& side) {
    return is_difference(side) ? "a difference of temperatures" : "a temperature";
  };
  report_scales(right, fill_in(doing, phrase(left), phrase(right)), diagnostics);
  return nullptr;
}

}  // namespace

bool fits_scale(Typed& number, const Wanted& wanted, Diagnostics& diagnostics) {
  if (wanted.difference) make_difference(number);
  const bool wrong =
      wanted.difference ? is_point(number) : wanted.unit->offset != 0 && is_difference(number);
  if (!wrong) return true;
  const std::string needed = wanted.difference ? "a difference of temperatures" : "a temperature";
  const std::string given = wanted.difference ? "a temperature" : "a difference of temperatures";
  report_scales(number, "`" + wanted.source + "` is " + needed + ", but this is " + given,
                diagnostics);
  return false;
}

bool unify_scales(Typed& left, Typed& right, std::string_view doing, Diagnostics& diagnostics) {
  if (is_difference(left)) make_difference(right);
  if (is_difference(right)) make_difference(left);
  const bool differ =
      (is_difference(left) && is_point(right)) || (is_point(left) && is_difference(right));
  return !differ || report_sum(left, right, doing, diagnostics) != nullptr;
}

const Unit* unify_sum(Typed& left, Typed& right, bool subtracts, std::string_view doing,
                      Diagnostics& diagnostics) {
  make_difference(right);
  if (!subtracts && is_point(right)) make_difference(left);
  const bool left_point = is_point(left);
  const bool right_point = is_point(right);
  if (left_point && right_point)
    return !subtracts && report_point(right, diagnostics) ? nullptr : &difference_unit(*left.unit);
  if (right_point && is_difference(left))
    return subtracts ? report_sum(left, right, doing, diagnostics) : right.unit;
  // What is in C may be a temperature or a difference: the sum is shown in C, which is right for both.
  const bool right_in_c = right.unit != nullptr && !right_point && !is_difference(right);
  const bool left_in_f = left_point || is_difference(left);
  const bool adds_constant = left_point && right.is_constant();
  return left_in_f && right_in_c && !adds_constant ? right.unit : left.unit;
}

}  // namespace robosync::compiler
