#include "compiler/codegen/operations.hpp"

#include <algorithm>
#include <iterator>

#include "vm/arithmetic.hpp"

namespace robosync::compiler {
namespace {

// A comparison, and the jump that includes it.
struct Jump {
  vm::Opcode comparison, unless;
};
constexpr Jump kJumps[] = {
    {vm::Opcode::lt, vm::Opcode::unless_lt},     {vm::Opcode::le, vm::Opcode::unless_le},
    {vm::Opcode::eq, vm::Opcode::unless_eq},     {vm::Opcode::ne, vm::Opcode::unless_ne},
    {vm::Opcode::lt_k, vm::Opcode::unless_lt_k}, {vm::Opcode::le_k, vm::Opcode::unless_le_k},
    {vm::Opcode::gt_k, vm::Opcode::unless_gt_k}, {vm::Opcode::ge_k, vm::Opcode::unless_ge_k},
    {vm::Opcode::eq_k, vm::Opcode::unless_eq_k}, {vm::Opcode::ne_k, vm::Opcode::unless_ne_k}};

vm::Opcode unless(vm::Opcode comparison) {
  return std::ranges::find(kJumps, comparison, &Jump::comparison)->unless;
}

WithConstant sum_with(const Expression& left, vm::Value constant) {
  const bool unchecked = left.fact.known && sum_fits(left.fact, fact_of(constant));
  return {unchecked ? vm::Opcode::add_k_fast : vm::Opcode::add_k, constant};
}

}  // namespace

vm::Opcode with_constant(Operation comparison) {
  switch (comparison) {
    case Operation::less:
      return vm::Opcode::lt_k;
    case Operation::less_equal:
      return vm::Opcode::le_k;
    case Operation::greater:
      return vm::Opcode::gt_k;
    case Operation::greater_equal:
      return vm::Opcode::ge_k;
    case Operation::equal:
      return vm::Opcode::eq_k;
    default:
      return vm::Opcode::ne_k;
  }
}

vm::Opcode with_cells(Operation operation) {
  switch (operation) {
    case Operation::add:
      return vm::Opcode::add;
    case Operation::subtract:
      return vm::Opcode::sub;
    case Operation::multiply:
      return vm::Opcode::mul;
    case Operation::divide:
      return vm::Opcode::div;
    case Operation::modulo:
      return vm::Opcode::mod;
    case Operation::minimum:
      return vm::Opcode::min;
    case Operation::maximum:
      return vm::Opcode::max;
    case Operation::round:
      return vm::Opcode::round;
    case Operation::random:
      return vm::Opcode::random;
    case Operation::lasted:
      return vm::Opcode::lasted;
    case Operation::less:
      return vm::Opcode::lt;
    case Operation::less_equal:
      return vm::Opcode::le;
    case Operation::equal:
      return vm::Opcode::eq;
    case Operation::not_equal:
      return vm::Opcode::ne;
    case Operation::logical_and:
      return vm::Opcode::and_;
    default:
      return vm::Opcode::or_;
  }
}

vm::Opcode unless_with_constant(Operation comparison) {
  return unless(with_constant(comparison));
}

vm::Opcode unless_with_cells(Operation comparison) {
  return unless(with_cells(comparison));
}

std::optional<vm::Opcode> compared_by(vm::Opcode jump) {
  const auto* const found = std::ranges::find(kJumps, jump, &Jump::unless);
  if (found == std::end(kJumps)) return std::nullopt;
  return found->comparison;
}

std::optional<WithConstant> constant_form(const Expression& expression) {
  if (expression.operands.size() != 2) return std::nullopt;
  const Expression& left = expression.operands[0];
  const Expression& right = expression.operands[1];
  if (right.operation != Operation::constant) return std::nullopt;
  const vm::Value constant = right.constant;
  const bool whole = constant % vm::kScale == 0;
  switch (expression.operation) {
    case Operation::add:
      return sum_with(left, constant);
    case Operation::subtract:
      return sum_with(left, vm::negate(constant));
    case Operation::multiply:
      if (!whole || !left.fact.known || !product_fits(left.fact, fact_of(constant))) break;
      return WithConstant{vm::Opcode::mul_k_fast, constant / vm::kScale};
    case Operation::divide:
      if (!whole || constant <= 0) break;
      return WithConstant{vm::Opcode::div_k, constant / vm::kScale};
    case Operation::modulo:
      if (constant <= 0) break;
      return WithConstant{vm::Opcode::mod_k, constant};
    default:
      break;
  }
  return std::nullopt;
}

std::optional<Unchecked> unchecked_form(const Expression& expression) {
  if (expression.operands.size() != 2) return std::nullopt;
  const Fact& left = expression.operands[0].fact;
  const Fact& right = expression.operands[1].fact;
  if (!left.known || !right.known) return std::nullopt;
  if (expression.operation == Operation::add && sum_fits(left, right))
    return Unchecked{vm::Opcode::add_fast};
  if (expression.operation == Operation::multiply && product_fits(left, right)) {
    if (left.whole) return Unchecked{vm::Opcode::mul_fast};
    if (right.whole) return Unchecked{vm::Opcode::mul_fast, true};
  }
  return std::nullopt;
}

}  // namespace robosync::compiler
