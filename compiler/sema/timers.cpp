// Part of Expressions: TIMERs. A TIMER is a variable that holds the time of its last RESTART; its value
// is the time since then. A comparison becomes a condition that knows when it will change
// (Operation::lasted), so nothing has to poll it. That is why a TIMER must be alone on its side.
#include <algorithm>
#include <utility>

#include "compiler/sema/expressions.hpp"
#include "vm/arithmetic.hpp"

namespace robosync::compiler {
namespace {

ast::Relation turned(ast::Relation relation) {
  switch (relation) {
    case ast::Relation::less:
      return ast::Relation::greater;
    case ast::Relation::less_equal:
      return ast::Relation::greater_equal;
    case ast::Relation::greater:
      return ast::Relation::less;
    case ast::Relation::greater_equal:
      return ast::Relation::less_equal;
    case ast::Relation::equal:
    case ast::Relation::not_equal:
      break;
  }
  return relation;
}

// "Longer than" starts a millisecond later than "as long as".
Expression more_than(Expression length) {
  if (length.operation != Operation::constant)
    return make_binary(Operation::add, std::move(length), make_constant_code(1));
  return make_constant_code(vm::add(length.constant, 1));
}

Expression lasted(const Expression& timer, Expression length) {
  return make_binary(Operation::lasted, timer.operands.front(), std::move(length));
}

Expression opposite(Expression condition) {
  return make_unary(Operation::logical_not, std::move(condition));
}

Expression compared(ast::Relation relation, const Expression& timer, Expression length) {
  switch (relation) {
    case ast::Relation::greater_equal:
      return lasted(timer, std::move(length));
    case ast::Relation::greater:
      return lasted(timer, more_than(std::move(length)));
    case ast::Relation::less:
      return opposite(lasted(timer, std::move(length)));
    case ast::Relation::less_equal:
      return opposite(lasted(timer, more_than(std::move(length))));
    case ast::Relation::equal:
    case ast::Relation::not_equal:
      break;
  }
  Expression longer = opposite(lasted(timer, more_than(length)));
  Expression same =
      make_binary(Operation::logical_and, lasted(timer, std::move(length)), std::move(longer));
  return relation == ast::Relation::equal ? same : opposite(std::move(same));
}

}  // namespace

bool Expressions::stands_still(const Expression& value, Span span, std::string_view where) {
  if (!reads_time(value)) return true;
  diagnostics_
      .report(Code::E0513,
              "a TIMER changes all the time, so it cannot be used in " + std::string(where))
      .label(span)
      .helps("compare it instead: the robot notices exactly when `idle > 30s` becomes true");
  return false;
}

Typed Expressions::time_comparison(ast::Relation relation, Typed left, Typed right, Span span) {
  if (left.code.operation != Operation::elapsed) {
    std::swap(left, right);
    relation = turned(relation);
  }
  if (left.code.operation == Operation::elapsed && !reads_time(right.code))
    return make_condition(compared(relation, left.code, std::move(right.code)), span);
  if (left.code.operation == Operation::elapsed && right.code.operation == Operation::elapsed) {
    diagnostics_.report(Code::E0513, "two TIMERs cannot be compared with each other")
        .label(span)
        .helps("compare each with a time: `idle > 30s`");
    return make_nothing(span);
  }
  diagnostics_.report(Code::E0513, "a TIMER must stand alone on one side of a comparison")
      .label(span)
      .helps("calculate on the other side: `idle > 2 * patience`");
  return make_nothing(span);
}

Typed Expressions::time_between(Typed value, Typed low, Typed high, Span span) {
  Typed same = value;
  Typed above =
      time_comparison(ast::Relation::greater_equal, std::move(value), std::move(low), span);
  if (above.type != Type::condition) return above;
  Typed below = time_comparison(ast::Relation::less_equal, std::move(same), std::move(high), span);
  if (below.type != Type::condition) return below;
  return make_condition(
      make_binary(Operation::logical_and, std::move(above.code), std::move(below.code)), span);
}

}  // namespace robosync::compiler
