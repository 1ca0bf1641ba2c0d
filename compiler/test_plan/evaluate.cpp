// Recursion is bounded by the parser's limit on the depth of expressions.
#include "compiler/test_plan/evaluate.hpp"

#include "compiler/ir/expression.hpp"
#include "vm/arithmetic.hpp"

namespace robosync::compiler::test_plan {

vm::Value evaluate(const Expression& expression, const Moment& moment) {
  const auto operand = [&](std::size_t place) {
    return evaluate(expression.operands[place], moment);
  };
  switch (expression.operation) {
    case Operation::constant:
      return expression.constant;
    case Operation::input:
      return moment.channel(expression.channel);
    case Operation::variable:
      return moment.variable(expression.index);
    case Operation::elapsed:
      return vm::subtract(moment.time(), operand(0));
    case Operation::lasted:
      return compute(Operation::greater_equal, vm::subtract(moment.time(), operand(0)), operand(1));
    case Operation::negate:
      return vm::negate(operand(0));
    case Operation::logical_not:
      return vm::logical_not(operand(0));
    default:
      return expression.operands.size() == 2 ? compute(expression.operation, operand(0), operand(1))
                                             : vm::kUnknown;
  }
}

}  // namespace robosync::compiler::test_plan
