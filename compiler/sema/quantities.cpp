#include "compiler/sema/quantities.hpp"

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
  Unit unit = *wanted.unit;
  if (wanted.difference) unit.offset = 0;
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
  number.unit = wanted.unit;
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
  if (left.dimension() == right.dimension()) return true;
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

bool report_offset_unit(const Typed& number, Diagnostics& diagnostics) {
  const bool is_point = number.is_number() && number.is_constant() && number.unit != nullptr &&
                        number.unit->offset != 0;
  if (is_point)
    diagnostics
        .report(Code::E0301, "RSL cannot calculate with `" + std::string(number.unit->spelling) +
                                 "`, only compare it")
        .label(number.span)
        .helps("write the temperature in `C` (Celsius)");
  return is_point;
}

void make_difference(Typed& number) {
  if (!number.is_constant() || number.unit == nullptr || number.unit->offset == 0 ||
      number.digits.empty())
    return;
  Unit unit = *number.unit;
  unit.offset = 0;
  const vm::Value value = to_value(number.bare, unit).value_or(number.code.constant);
  number.code.constant = value;
  number.low = value;
  number.high = value;
}

}  // namespace robosync::compiler
