// Part of Expressions: the numeric functions (compiler/syntax/functions.def).
#include "compiler/syntax/functions.hpp"

#include <array>
#include <utility>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/ir/expression.hpp"
#include "compiler/sema/expressions.hpp"
#include "vm/arithmetic.hpp"

namespace robosync::compiler {
namespace {

// In the order of kFunctions.
constexpr std::array kOperations = {
#define FUNCTION(name, operation, arguments) Operation::operation,
#include "compiler/syntax/functions.def"
#undef FUNCTION
};
constexpr unsigned kDecimals = 3;  // of constants folded here

// ROUND rounds to whole numbers of this unit: the one that the number is declared in.
const Unit& unit_of(const Typed& number) {
  return number.unit != nullptr ? *number.unit : canonical_unit(number.dimension());
}

// The value of one unit, to the nearest thousandth (rad is not a whole number of thousandths).
vm::Value step_of(const Unit& unit) {
  return static_cast<vm::Value>((unit.factor + unit.divisor / 2) / unit.divisor);
}

// If the unit's scale has an offset (F), its whole numbers are not multiples of a step. They are on the
// scale of units.def before the division, so this rounds there and converts back.
Expression rounded(Expression number, const Unit& unit) {
  if (unit.offset == 0)
    return make_binary(Operation::round, std::move(number), make_constant_code(step_of(unit)));
  const auto constant = [](std::int64_t value) {
    return make_constant_code(static_cast<vm::Value>(value));
  };
  const Expression divisor = constant(unit.divisor * vm::kScale), offset = constant(unit.offset);
  Expression scaled = make_binary(Operation::multiply, std::move(number), divisor);
  scaled = make_binary(Operation::subtract, std::move(scaled), offset);
  scaled = make_binary(Operation::round, std::move(scaled), constant(unit.factor));
  scaled = make_binary(Operation::add, std::move(scaled), offset);
  return make_binary(Operation::divide, std::move(scaled), divisor);
}

void become_constant(Typed& number, vm::Value value) {
  number.code = make_constant_code(value);
  number.bare = {value, kDecimals};
  number.digits.clear();
  number.low = value;
  number.high = value;
}

}  // namespace

Typed Expressions::of(const ast::Function& node, Span span) {
  const FunctionName* const known = find_function(node.name.text);
  if (known == nullptr) {
    Diagnostic& d = diagnostics_.report(Code::E0501, "there is no function " + node.name.shown())
                        .label(node.name.span);
    std::vector<std::string> names;
    std::string list;
    for (const FunctionName& function : kFunctions) {
      names.emplace_back(function.name);
      list += (list.empty() ? "" : ", ") + names.back();
    }
    names.emplace_back("RANDOM");
    did_you_mean(d, node.name.span, node.name.text, names);
    if (d.help.empty()) d.helps("functions: " + list + " and RANDOM");
    return make_nothing(span);
  }
  const std::size_t given = node.second == nullptr ? 1 : 2;
  if (given != known->arguments) {
    diagnostics_
        .report(Code::E0411, "`" + std::string(known->name) + "` takes " +
                                 (known->arguments == 1 ? "one number" : "two numbers") +
                                 ", but is given " + (given == 1 ? "one" : "two"))
        .label(span)
        .helps("write `" + std::string(known->name) +
               (known->arguments == 1 ? "(number)`" : "(number, number)`"));
    return make_nothing(span);
  }
  const Operation operation = kOperations.at(static_cast<std::size_t>(known - kFunctions.data()));
  return given == 1 ? of_one(operation, node, span) : of_two(operation, node, span);
}

Typed Expressions::of_one(Operation operation, const ast::Function& node, Span span) {
  Typed inner = number(*node.first);
  const bool rounds = operation == Operation::round;
  const bool takes_points = rounds && !inner.is_constant();
  if (!inner.is_number() || (!takes_points && report_point(inner, diagnostics_)))
    return make_nothing(span);
  const Unit& unit = unit_of(inner);
  const vm::Value step = step_of(unit);
  inner.span = span;
  if (inner.is_constant()) {
    const vm::Value value = inner.code.constant;
    become_constant(inner, rounds ? vm::round_to(value, step) : vm::absolute(value));
    return inner;
  }
  if (rounds) {
    inner.code = rounded(std::move(inner.code), unit);
    inner.low -= step;
    inner.high += step;
    return inner;
  }
  inner.code = make_unary(operation, std::move(inner.code));
  const std::int64_t most = std::max(-inner.low, inner.high);
  inner.low = std::max<std::int64_t>({inner.low, -inner.high, 0});
  inner.high = most;
  return inner;
}

Typed Expressions::of_two(Operation operation, const ast::Function& node, Span span) {
  const bool least = operation == Operation::minimum;
  Typed left = number(*node.first);
  Typed right = number(*node.second);
  if (!left.is_number() || !right.is_number()) return make_nothing(span);
  if (!unify(left, right,
             least ? "this takes the smaller of {} and {}" : "this takes the larger of {} and {}",
             false, diagnostics_))
    return make_nothing(span);
  const auto chosen = [least](std::int64_t one, std::int64_t other) {
    return least ? std::min(one, other) : std::max(one, other);
  };
  Typed result = left;
  result.span = span;
  if (left.unit == nullptr) result.unit = right.unit;
  if (left.is_constant() && right.is_constant()) {
    become_constant(result, compute(operation, left.code.constant, right.code.constant));
    return result;
  }
  result.digits.clear();
  result.low = chosen(left.low, right.low);
  result.high = chosen(left.high, right.high);
  if (result.unit == nullptr) result.unit = &canonical_unit(vm::Dimension::number);
  result.code = make_binary(operation, std::move(left.code), std::move(right.code));
  return result;
}

}  // namespace robosync::compiler
