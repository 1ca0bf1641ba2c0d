// Sums, products and RANDOM: their units, their ranges, and constants worked out.
#include <algorithm>
#include <array>

#include "compiler/ir/compute.hpp"
#include "compiler/sema/expressions.hpp"

namespace robosync::compiler {
namespace {

constexpr unsigned kBareDecimals = 3;  // folded constants are thousandths

Operation operation_of(ast::ArithmeticOp op) {
  constexpr std::array kOperations = {Operation::add, Operation::subtract, Operation::multiply,
                                      Operation::divide, Operation::modulo};
  return kOperations[static_cast<std::size_t>(op)];
}

// What the result of an addition, subtraction or modulo of ranges can be.
void set_range(Typed& result, const Typed& left, const Typed& right) {
  const auto clamp = [](std::int64_t value) {
    return std::clamp<std::int64_t>(value, vm::kValueMin, vm::kValueMax);
  };
  if (result.code.operation == Operation::add) {
    result.low = clamp(left.low + right.low);
    result.high = clamp(left.high + right.high);
  } else if (result.code.operation == Operation::subtract) {
    result.low = clamp(left.low - right.high);
    result.high = clamp(left.high - right.low);
  }
}

}  // namespace

Typed Expressions::of(const ast::Negate& node, Span span) {
  Typed inner = number(*node.value);
  if (!inner.is_number() || report_offset_unit(inner, diagnostics_)) return make_nothing(span);
  if (inner.is_constant()) {
    inner.code.constant = -inner.code.constant;
    inner.bare.mantissa = -inner.bare.mantissa;
    if (!inner.digits.empty()) inner.digits = "-" + inner.digits;
  } else {
    inner.code = make_unary(Operation::negate, std::move(inner.code));
  }
  inner.span = span;
  const std::int64_t low = inner.low;
  inner.low = -inner.high;
  inner.high = -low;
  return inner;
}

Typed Expressions::of(const ast::Arithmetic& node, Span span) {
  Typed left = number(*node.left);
  Typed right = number(*node.right);
  if (!left.is_number() || !right.is_number()) return make_nothing(span);
  if (report_offset_unit(left, diagnostics_) || report_offset_unit(right, diagnostics_))
    return make_nothing(span);
  const bool divides = node.op == ast::ArithmeticOp::div || node.op == ast::ArithmeticOp::mod;
  if (divides) check_divisor(right);
  const bool scales = node.op == ast::ArithmeticOp::mul || node.op == ast::ArithmeticOp::div;
  return scales ? product(node, std::move(left), std::move(right), span)
                : sum(node, std::move(left), std::move(right), span);
}

void Expressions::check_divisor(const Typed& divisor) {
  if (divisor.low > 0 || divisor.high < 0) return;
  const bool certain = divisor.is_constant();
  diagnostics_
      .report(Code::W0217, certain ? "this divides by zero, which gives 0"
                                   : "this can be zero, and a division by zero gives 0")
      .label(divisor.span);
}

// +, - and MOD: both sides are of one dimension.
Typed Expressions::sum(const ast::Arithmetic& node, Typed left, Typed right, Span span) {
  constexpr std::array<std::string_view, 5> kDoing = {"this adds {} and {}",
                                                      "this takes the difference of {} and {}", "",
                                                      "", "this divides {} by {}"};
  if (!unify(left, right, kDoing[static_cast<std::size_t>(node.op)], true, diagnostics_))
    return make_nothing(span);
  const Unit* unit = left.unit;
  return combine(node.op, std::move(left), std::move(right), unit, span);
}

// * and /: one side is a plain number, or both are of one dimension and the quotient is plain.
Typed Expressions::product(const ast::Arithmetic& node, Typed left, Typed right, Span span) {
  const Unit& plain = canonical_unit(vm::Dimension::number);
  const bool divides = node.op == ast::ArithmeticOp::div;
  const bool left_plain = left.dimension() == vm::Dimension::number;
  const bool right_plain = right.dimension() == vm::Dimension::number;
  const Unit* unit = right_plain ? left.unit : right.unit;
  if (left_plain && right_plain && unit == nullptr && !(left.is_bare() && right.is_bare()))
    unit = &plain;
  if (divides && !right_plain) {
    if (left.dimension() != right.dimension()) {
      report_mismatch(left, right, "this divides {} by {}", diagnostics_)
          .helps("divide by a plain number, or by " +
                 std::string(dimension_phrase(left.dimension())));
      return make_nothing(span);
    }
    unit = &plain;
  } else if (!left_plain && !right_plain) {
    report_mismatch(left, right, "this multiplies {} by {}", diagnostics_)
        .helps("one side of a product must be a plain number");
    return make_nothing(span);
  }
  return combine(node.op, std::move(left), std::move(right), unit, span);
}

Typed Expressions::combine(ast::ArithmeticOp op, Typed left, Typed right, const Unit* unit,
                           Span span) {
  Typed result;
  result.type = Type::number;
  result.span = span;
  result.unit = unit;
  const Typed& named = left.source.empty() ? right : left;
  const bool same_unit = !named.source.empty() && named.unit == unit;
  result.source = same_unit ? named.source : "";
  result.unit_span = same_unit ? named.unit_span : span;
  result.code.operation = operation_of(op);
  set_range(result, left, right);
  if (left.is_constant() && right.is_constant()) return fold(left, right, std::move(result));
  result.code = make_binary(operation_of(op), std::move(left.code), std::move(right.code));
  return result;
}

Typed Expressions::fold(const Typed& left, const Typed& right, Typed result) {
  const vm::Value value = compute(result.code.operation, left.code.constant, right.code.constant);
  if (value == vm::kValueMax || value == vm::kValueMin) {
    diagnostics_.report(Code::E0304, "the result of this is too large for the robot")
        .label(result.span);
    return make_nothing(result.span);
  }
  result.code = {};
  result.code.constant = value;
  result.bare = {value, kBareDecimals};
  result.low = value;
  result.high = value;
  return result;
}

// A bare pair is one of plain numbers: it is drawn on the robot, so it has no literal's freedom.
Typed Expressions::of(const ast::Random& node, Span span) {
  Typed low = number(*node.low);
  Typed high = number(*node.high);
  if (!low.is_number() || !high.is_number()) return make_nothing(span);
  if (!unify(low, high, "this draws a number between {} and {}", false, diagnostics_))
    return make_nothing(span);
  if (low.low > high.high) {
    diagnostics_.report(Code::E0509, "RANDOM goes from the smaller number to the larger one")
        .label(span);
    return make_nothing(span);
  }
  Typed result;
  result.type = Type::number;
  result.span = span;
  result.unit = low.unit != nullptr ? low.unit : &canonical_unit(vm::Dimension::number);
  result.unit_span = low.unit_span;
  result.low = low.low;
  result.high = high.high;
  result.code = make_binary(Operation::random, std::move(low.code), std::move(high.code));
  return result;
}

}  // namespace robosync::compiler
