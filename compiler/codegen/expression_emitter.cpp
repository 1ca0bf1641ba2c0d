#include "compiler/codegen/expression_emitter.hpp"

#include <algorithm>
#include <utility>

#include "compiler/codegen/operations.hpp"

namespace robosync::compiler {
namespace {

bool reads_local(const Expression& expression) {
  return expression.operation == Operation::local ||
         std::any_of(expression.operands.begin(), expression.operands.end(), reads_local);
}

// x * 2 saturates where x + x does. A product whose operand is known has its own instruction.
bool is_double(const Expression& expression) {
  constexpr vm::Value kTwo = 2 * vm::kScale;
  return expression.operation == Operation::multiply && !expression.operands[0].fact.known &&
         expression.operands[1].operation == Operation::constant &&
         expression.operands[1].constant == kTwo;
}

// True if two equal expressions may be evaluated once. Equal time words always have the same value, but those with two operands
// use the register of the first one for themselves.
bool can_be_shared(const Expression& expression) {
  const bool two = is_time_word(expression.operation) && expression.operands.size() > 1;
  return expression.operation != Operation::random && !two &&
         std::all_of(expression.operands.begin(), expression.operands.end(), can_be_shared);
}

constexpr std::size_t kMaxLookedAt = 64;  // parts of a condition that are compared

std::uint32_t after(Cell cell, std::uint32_t depth) {
  return cell.zone == Zone::temporary ? depth + 1 : depth;
}

}  // namespace

Cell ExpressionEmitter::condition(const Expression& expression) {
  std::vector<const Expression*> seen;
  if (parts_.program.shares) share(expression, seen);
  return value(expression, static_cast<std::uint32_t>(shared_.size()));
}

// Outer parts first: the inside of a part that is shared is not searched.
void ExpressionEmitter::share(const Expression& expression, std::vector<const Expression*>& seen) {
  if (expression.operands.empty() || seen.size() == kMaxLookedAt) return;
  const auto same = [&](const Expression* other) { return *other == expression; };
  const auto first = std::find_if(seen.begin(), seen.end(), same);
  if (first != seen.end() && can_be_shared(expression)) {
    const auto known = [&](const Shared& shared) { return shared.part == *first; };
    if (std::none_of(shared_.begin(), shared_.end(), known)) {
      const auto place = static_cast<std::uint32_t>(shared_.size());
      shared_.push_back({*first, parts_.frame.temporary(place)});
    }
    return;
  }
  seen.push_back(&expression);
  for (const Expression& operand : expression.operands)
    share(operand, seen);
}

Cell ExpressionEmitter::value(const Expression& expression, std::uint32_t depth) {
  for (Shared& shared : shared_) {
    if (!(*shared.part == expression)) continue;
    if (!shared.done) put_into(shared.cell, worked_out(expression, depth));
    shared.done = true;
    return shared.cell;
  }
  return worked_out(expression, depth);
}

Cell ExpressionEmitter::worked_out(const Expression& expression, std::uint32_t depth) {
  const auto& operands = expression.operands;
  const Operation operation = expression.operation;
  switch (operation) {
    case Operation::input:
      return parts_.frame.read(parts_.tables.input(expression.channel));
    case Operation::variable:
      return variable(expression.index, depth);
    case Operation::local:
      return locals_.at(expression.index);
    case Operation::constant:
      return constant(expression.constant, depth);
    case Operation::now:
      return now(depth);
    case Operation::elapsed:
      return unary(vm::Opcode::elapsed, operands[0], depth);
    case Operation::negate:
      return unary(vm::Opcode::neg, operands[0], depth);
    case Operation::absolute:
      return unary(vm::Opcode::abs, operands[0], depth);
    case Operation::logical_not:
      return unary(vm::Opcode::not_, operands[0], depth);
    default:
      break;
  }
  if (is_time_word(operation))
    return time_words_ == TimeWords::watched ? watched(expression) : time_word(expression, depth);
  if (is_comparison(operation)) return comparison(operation, operands[0], operands[1], depth);
  if (parts_.program.optimized)
    if (const auto cell = cheaper(expression, depth)) return *cell;
  return binary(with_cells(operation), operands[0], operands[1], depth);
}

void ExpressionEmitter::put_into(Cell target, Cell cell) {
  if (cell.zone == Zone::temporary)
    code_.retarget(target);  // the last instruction computes the value
  else
    code_.emit(vm::Opcode::move, target, cell);
}

Cell ExpressionEmitter::constant(vm::Value value, std::uint32_t depth) {
  const Cell cell = parts_.frame.temporary(depth);
  code_.emit(vm::Opcode::load, cell, static_cast<std::uint32_t>(parts_.pool.constant(value)));
  return cell;
}

Cell ExpressionEmitter::now(std::uint32_t depth) {
  const Cell cell = parts_.frame.temporary(depth);
  code_.emit(vm::Opcode::now, cell);
  return cell;
}

Cell ExpressionEmitter::unary(vm::Opcode opcode, const Expression& operand, std::uint32_t depth) {
  const Cell source = value(operand, depth);
  const Cell cell = parts_.frame.temporary(depth);
  code_.emit(opcode, cell, source);
  return cell;
}

Cell ExpressionEmitter::binary(vm::Opcode opcode, const Expression& left, const Expression& right,
                               std::uint32_t depth, bool exchanged) {
  Cell left_cell = value(left, depth);
  Cell right_cell = value(right, after(left_cell, depth));
  if (exchanged) std::swap(left_cell, right_cell);
  const Cell cell = parts_.frame.temporary(depth);
  code_.emit(opcode, cell, left_cell, right_cell);
  return cell;
}

// An instruction with a constant operand, or one without checks that were proved unnecessary.
std::optional<Cell> ExpressionEmitter::cheaper(const Expression& expression, std::uint32_t depth) {
  if (is_double(expression)) {
    const Cell once = value(expression.operands[0], depth);
    const Cell cell = parts_.frame.temporary(depth);
    code_.emit(vm::Opcode::add, cell, once, once);
    return cell;
  }
  if (const auto form = constant_form(expression)) {
    if (const auto place = parts_.pool.near_constant(form->constant)) {
      const Cell left = value(expression.operands[0], depth);
      const Cell cell = parts_.frame.temporary(depth);
      code_.emit(form->opcode, cell, left, *place);
      return cell;
    }
  }
  if (const auto form = unchecked_form(expression))
    return binary(form->opcode, expression.operands[0], expression.operands[1], depth,
                  form->exchanged);
  return std::nullopt;
}

std::optional<std::size_t> ExpressionEmitter::jump_unless(const Expression& comparison) {
  const Operation operation = comparison.operation;
  if (!is_comparison(operation)) return std::nullopt;
  const Expression& left = comparison.operands[0];
  const Expression& right = comparison.operands[1];
  if (right.operation == Operation::constant) {
    if (!parts_.pool.near_constant(right.constant)) return std::nullopt;
    return jump_unless(operation, value(left), right.constant);
  }
  // Evaluates in the same order as comparison(), because the operands may draw random numbers.
  const bool turned = operation == Operation::greater || operation == Operation::greater_equal;
  const Cell first = value(turned ? right : left);
  const Cell second = value(turned ? left : right, after(first, 0));
  (void)parts_.frame.temporary(0);  // CodeDraft::land() may need it
  return code_.emit(unless_with_cells(turned ? mirrored(operation) : operation), first, second);
}

std::optional<std::size_t> ExpressionEmitter::jump_unless(Operation comparison, Cell left,
                                                          vm::Value right) {
  const auto place = parts_.pool.near_constant(right);
  if (!place) return std::nullopt;
  (void)parts_.frame.temporary(0);  // CodeDraft::land() may need it
  return code_.emit(unless_with_constant(comparison), left, *place);
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
  const vm::Opcode opcode = vm::time_word_of(timer_kind(expression.operation));
  const Cell cell = parts_.frame.temporary(depth);
  Cell source = value(operands[0], depth);
  // The opcodes with two operands expect the first one in their result register.
  const bool there = source.zone == cell.zone && source.number == cell.number;
  if (operands.size() > 1 && !there) code_.emit(vm::Opcode::move, cell, source);
  if (operands.size() > 1) source = value(operands[1], depth + 1);
  code_.emit(opcode, cell, source, static_cast<std::uint32_t>(parts_.timers.add(expression)));
  return cell;
}

Cell ExpressionEmitter::watched(const Expression& expression) {
  std::vector<Watch>& watches = parts_.watches;
  const auto same = std::find_if(watches.begin(), watches.end(),
                                 [&](const Watch& watch) { return watch.time_word == expression; });
  // In another response, a local with the same number is a different local.
  if (same != watches.end() && !reads_local(expression)) return same->truth;
  watches.push_back({expression, locals_, parts_.frame.add_watch(), code_.source()});
  return watches.back().truth;
}

Cell ExpressionEmitter::variable(std::size_t place, std::uint32_t depth) {
  Cell cell = parts_.frame.read(parts_.tables.variable(place));
  if (!bounded_.contains(place)) return cell;
  const ir::Variable& variable = parts_.program.variables[place];
  if (variable.min > vm::kValueMin) cell = limited(vm::Opcode::max_k, cell, variable.min, depth);
  if (variable.max < vm::kValueMax) cell = limited(vm::Opcode::min_k, cell, variable.max, depth);
  return cell;
}

Cell ExpressionEmitter::clamped(Cell source, const ir::Variable& variable, const ir::Set& set) {
  if (variable.min > vm::kValueMin && set.may_be_below)
    source = limited(vm::Opcode::max_k, source, variable.min, 0);
  if (variable.max < vm::kValueMax && set.may_be_above)
    source = limited(vm::Opcode::min_k, source, variable.max, 0);
  return source;
}

Cell ExpressionEmitter::limited(vm::Opcode opcode, Cell source, vm::Value limit,
                                std::uint32_t depth) {
  const Cell cell = parts_.frame.temporary(depth);
  const auto place = static_cast<std::uint32_t>(parts_.pool.constant(limit));
  code_.emit(opcode, cell, source, place);
  return cell;
}

}  // namespace robosync::compiler
