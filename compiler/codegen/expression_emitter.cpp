#include "compiler/codegen/expression_emitter.hpp"

#include <algorithm>

#include "compiler/codegen/operations.hpp"

namespace robosync::compiler {
namespace {

bool reads_local(const Expression& expression) {
  return expression.operation == Operation::local ||
         std::any_of(expression.operands.begin(), expression.operands.end(), reads_local);
}

std::uint32_t after(Cell cell, std::uint32_t depth) {
  return cell.zone == Zone::temporary ? depth + 1 : depth;
}

}  // namespace

Cell ExpressionEmitter::value(const Expression& expression, std::uint32_t depth) {
  const auto& operands = expression.operands;
  const Operation operation = expression.operation;
  switch (operation) {
    case Operation::input:
      return parts_.frame.read(parts_.tables.input(expression.channel));
    case Operation::variable:
      return parts_.frame.read(parts_.tables.variable(expression.index));
    case Operation::local:
      return locals_.at(expression.index);
    case Operation::constant:
      return constant(expression.constant, depth);
    case Operation::negate:
      return unary(vm::Opcode::neg, operands[0], depth);
    case Operation::logical_not:
      return unary(vm::Opcode::not_, operands[0], depth);
    default:
      break;
  }
  if (is_time_word(operation))
    return time_words_ == TimeWords::watched ? watched(expression) : time_word(expression, depth);
  if (is_comparison(operation)) return comparison(operation, operands[0], operands[1], depth);
  return binary(with_cells(operation), operands[0], operands[1], depth);
}

void ExpressionEmitter::value_into(Cell local, const Expression& expression) {
  const Cell cell = value(expression);
  if (cell.zone == Zone::temporary)
    code_.retarget(local);  // the last instruction is the one that gives the value
  else
    code_.emit(vm::Opcode::move, local, cell);
}

Cell ExpressionEmitter::constant(vm::Value value, std::uint32_t depth) {
  const Cell cell = parts_.frame.temporary(depth);
  code_.emit(vm::Opcode::load, cell, static_cast<std::uint32_t>(parts_.pool.constant(value)));
  return cell;
}

Cell ExpressionEmitter::unary(vm::Opcode opcode, const Expression& operand, std::uint32_t depth) {
  const Cell source = value(operand, depth);
  const Cell cell = parts_.frame.temporary(depth);
  code_.emit(opcode, cell, source);
  return cell;
}

Cell ExpressionEmitter::binary(vm::Opcode opcode, const Expression& left, const Expression& right,
                               std::uint32_t depth) {
  const Cell left_cell = value(left, depth);
  const Cell right_cell = value(right, after(left_cell, depth));
  const Cell cell = parts_.frame.temporary(depth);
  code_.emit(opcode, cell, left_cell, right_cell);
  return cell;
}

Cell ExpressionEmitter::comparison(Operation operation, const Expression& left,
                                   const Expression& right, std::uint32_t depth) {
  if (left.operation == Operation::constant && right.operation != Operation::constant)
    return comparison(mirrored(operation), right, left, depth);
  if (right.operation == Operation::constant)
    return compare(operation, value(left, depth), right.constant, depth);
  if (operation == Operation::greater || operation == Operation::greater_equal)
    return binary(with_cells(mirrored(operation)), right, left, depth);
  return binary(with_cells(operation), left, right, depth);
}

Cell ExpressionEmitter::compare(Operation operation, Cell left, vm::Value right,
                                std::uint32_t depth) {
  const Cell cell = parts_.frame.temporary(depth);
  const std::size_t place = parts_.pool.constant(right);
  if (place < kMaxConst8) {
    code_.emit(with_constant(operation), cell, left, static_cast<std::uint32_t>(place));
    return cell;
  }
  const Cell right_cell = constant(right, after(left, depth));
  if (operation == Operation::greater || operation == Operation::greater_equal)
    code_.emit(with_cells(mirrored(operation)), cell, right_cell, left);
  else
    code_.emit(with_cells(operation), cell, left, right_cell);
  return cell;
}

Cell ExpressionEmitter::time_word(const Expression& expression, std::uint32_t depth) {
  const auto& operands = expression.operands;
  const vm::Opcode opcode = of_time_word(expression.operation);
  const Cell cell = parts_.frame.temporary(depth);
  Cell source = value(operands[0], depth);
  // The opcodes of two operands have the first one where they put the result.
  if (operands.size() > 1) source = value(operands[1], depth + 1);
  code_.emit(opcode, cell, source, static_cast<std::uint32_t>(parts_.timers.add(expression)));
  return cell;
}

Cell ExpressionEmitter::watched(const Expression& expression) {
  std::vector<Watch>& watches = parts_.watches;
  const auto same = std::find_if(watches.begin(), watches.end(),
                                 [&](const Watch& watch) { return watch.time_word == expression; });
  // Locals of the same number are others in another response.
  if (same != watches.end() && !reads_local(expression)) return same->truth;
  watches.push_back({expression, locals_, parts_.frame.add_watch(), code_.source()});
  return watches.back().truth;
}

Cell ExpressionEmitter::clamped(Cell source, const ProgramVariable& variable) {
  if (variable.min > vm::kValueMin) source = limited(vm::Opcode::max_k, source, variable.min);
  if (variable.max < vm::kValueMax) source = limited(vm::Opcode::min_k, source, variable.max);
  return source;
}

Cell ExpressionEmitter::limited(vm::Opcode opcode, Cell source, vm::Value limit) {
  const Cell cell = parts_.frame.temporary(0);
  const auto place = static_cast<std::uint32_t>(parts_.pool.constant(limit));
  code_.emit(opcode, cell, source, place);
  return cell;
}

}  // namespace robosync::compiler
