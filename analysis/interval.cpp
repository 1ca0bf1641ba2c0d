// See interval.hpp. Uses the arithmetic of the interpreter itself (vm/arithmetic.hpp).
#include "analysis/interval.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "vm/arithmetic.hpp"
#include "vm/opcode.hpp"

namespace robosync::analysis {
namespace {

using vm::Opcode, vm::Value;
using Operation = std::int64_t (*)(Value, Value);

// For an operation that is monotonic in each operand, whatever the other is: its bounds are those of the
// corners. If a corner is out of range, the result may be anything.
Interval by_corners(Interval b, Interval c, Operation of) {
  const bool unknown = b.may_be_unknown() || c.may_be_unknown();
  b = known(b);
  c = known(c);
  const std::array corners{of(b.low, c.low), of(b.low, c.high), of(b.high, c.low),
                           of(b.high, c.high)};
  const auto [low, high] = std::ranges::minmax(corners);
  if (low < vm::kValueMin || high > vm::kValueMax) return {};
  return {unknown ? vm::kUnknown : static_cast<Value>(low), static_cast<Value>(high)};
}

// x / 0 is 0, and x divided by a small number is large.
Interval quotient(Interval b, Interval c) {
  if (known(c).low <= 0 && c.high >= 0) return {};
  return by_corners(b, c, [](Value x, Value y) { return std::int64_t{vm::divide(x, y)}; });
}

// An unchecked operation may give anything if an operand is unknown.
Interval unchecked(Interval b, Interval c, Operation of) {
  const Interval result = by_corners(b, c, of);
  return result.may_be_unknown() ? Interval{} : result;
}

Interval size_of(Interval b) {
  if (b.low >= 0) return b;
  const Interval is = known(b);
  const Value low = is.high < 0 ? -is.high : 0;
  return {b.may_be_unknown() ? vm::kUnknown : low, std::max(-is.low, is.high)};
}

Operation operation_of(Opcode op) {
  switch (op) {
    case Opcode::add:
    case Opcode::add_k:
      return [](Value x, Value y) { return std::int64_t{vm::add(x, y)}; };
    case Opcode::sub:
      return [](Value x, Value y) { return std::int64_t{vm::subtract(x, y)}; };
    case Opcode::mul:
      return [](Value x, Value y) { return std::int64_t{vm::multiply(x, y)}; };
    case Opcode::div_k:
      return [](Value x, Value y) { return std::int64_t{vm::divide_by_whole(x, y)}; };
    case Opcode::min:
    case Opcode::min_k:
      return [](Value x, Value y) { return std::int64_t{std::min(x, y)}; };
    case Opcode::max:
    case Opcode::max_k:
      return [](Value x, Value y) { return std::int64_t{std::max(x, y)}; };
    case Opcode::add_fast:
    case Opcode::add_k_fast:
      return [](Value x, Value y) { return std::int64_t{x} + y; };
    case Opcode::mul_fast:
      return [](Value x, Value y) { return std::int64_t{x / vm::kScale} * y; };
    case Opcode::mul_k_fast:
      return [](Value x, Value y) { return std::int64_t{x} * y; };
    case Opcode::round:
      return [](Value x, Value y) { return std::int64_t{vm::round_to(x, y)}; };
    default:
      return nullptr;
  }
}

}  // namespace

Interval hull(Interval a, Interval b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

Interval known(Interval a) {
  return {std::max(a.low, vm::kValueMin), std::max(a.high, vm::kValueMin)};
}

Interval result_of(const vm::Image& image, vm::Word word, std::span<const Interval> cells) {
  const Opcode op = vm::opcode_of(word);
  const auto operands = vm::info_of(op).operands;
  const auto at = [&](vm::Operand kind, std::size_t number) {
    if (kind == vm::Operand::read) return cells[number];
    const Value constant = number < image.constants.size() ? image.constants[number] : 0;
    return Interval{constant, constant};
  };
  const Interval b =
      at(operands[1], vm::is_wide(operands[1]) ? vm::operand_wide(word) : vm::operand_b(word));
  const Interval c = at(operands[2], vm::operand_c(word));
  switch (op) {
    case Opcode::move:
    case Opcode::load:
      return b;
    case Opcode::neg:
      return by_corners(b, b, [](Value x, Value) { return std::int64_t{vm::negate(x)}; });
    case Opcode::abs:
      return size_of(b);
    case Opcode::div:
      return quotient(b, c);
    case Opcode::random:
      return hull(b, c);
    case Opcode::elapsed:  // the time of a TIMER, always known
      return {0, vm::kValueMax};
    case Opcode::add_fast:
    case Opcode::add_k_fast:
    case Opcode::mul_fast:
    case Opcode::mul_k_fast:
      return unchecked(b, c, operation_of(op));
    default:
      break;
  }
  // Rounding to multiples of a varying number is not monotonic.
  if (op == Opcode::round && c.low != c.high) return {};
  const Operation operation = operation_of(op);
  return operation == nullptr ? Interval{} : by_corners(b, c, operation);
}

}  // namespace robosync::analysis
