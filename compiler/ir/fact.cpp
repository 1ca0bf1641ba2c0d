#include "compiler/ir/fact.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "vm/arithmetic.hpp"

namespace robosync::compiler {
namespace {

using vm::kScale;
using vm::Value;

Value cut_off(std::int64_t value) {
  return static_cast<Value>(std::clamp<std::int64_t>(value, vm::kValueMin, vm::kValueMax));
}

bool in_range(std::int64_t value) {
  return value >= vm::kValueMin && value <= vm::kValueMax;
}

std::int64_t size_of(const Fact& fact) {
  return std::max(std::abs(std::int64_t{fact.low}), std::abs(std::int64_t{fact.high}));
}

// For an operation that is monotonous in each operand: its extremes are at the corners of the ranges.
template <typename Operation>
Fact at_corners(const Fact& b, const Fact& c, Operation operation) {
  const std::array<Value, 4> corners = {operation(b.low, c.low), operation(b.low, c.high),
                                        operation(b.high, c.low), operation(b.high, c.high)};
  const auto [low, high] = std::minmax_element(corners.begin(), corners.end());
  return {b.known && c.known, false, *low, *high};
}

Fact truth_of(bool known, bool may_be_true, bool may_be_false) {
  return {known, false, may_be_true ? vm::kTrue : vm::kFalse,
          may_be_false ? vm::kFalse : vm::kTrue};
}

}  // namespace

Fact fact_of(Value constant) {
  if (constant == vm::kUnknown) return {};
  return {true, constant % kScale == 0, constant, constant};
}

Fact known_between(Value low, Value high, bool whole) {
  return {true, whole, low, high};
}

Fact either(const Fact& one, const Fact& other) {
  return {one.known && other.known, one.whole && other.whole, std::min(one.low, other.low),
          std::max(one.high, other.high)};
}

// ---- numbers

Fact negate(const Fact& b) {
  return {b.known, b.whole, vm::negate(b.high), vm::negate(b.low)};
}

bool sum_fits(const Fact& b, const Fact& c) {
  return in_range(std::int64_t{b.low} + c.low) && in_range(std::int64_t{b.high} + c.high);
}

// A sum that saturates is not whole.
Fact add(const Fact& b, const Fact& c) {
  return {b.known && c.known, b.whole && c.whole && sum_fits(b, c),
          cut_off(std::int64_t{b.low} + c.low), cut_off(std::int64_t{b.high} + c.high)};
}

Fact subtract(const Fact& b, const Fact& c) {
  return add(b, negate(c));
}

bool product_fits(const Fact& b, const Fact& c) {
  return size_of(b) * size_of(c) / kScale < vm::kValueMax;
}

Fact multiply(const Fact& b, const Fact& c) {
  Fact result = at_corners(b, c, [](Value x, Value y) { return vm::multiply(x, y); });
  result.whole = b.whole && c.whole && product_fits(b, c);
  return result;
}

Fact divide(const Fact& b, const Fact& c) {
  if (c.low > 0 || c.high < 0)
    return at_corners(b, c, [](Value x, Value y) { return vm::divide(x, y); });
  return {b.known && c.known, false};
}

// A remainder has the sign of the divisor and is smaller in magnitude, by at least one if both are whole.
Fact modulo(const Fact& b, const Fact& c) {
  const bool known = b.known && c.known;
  const bool whole = b.whole && c.whole;
  if (c.low > 0 && b.lies_in(0, c.low - 1)) return {known, b.whole, b.low, b.high};
  const Value least = whole ? kScale : 1;
  const Value low = c.low < 0 ? std::min(c.low + least, 0) : 0;
  const Value high = c.high > 0 ? std::max(c.high - least, 0) : 0;
  return {known, whole, low, high};
}

Fact absolute(const Fact& b) {
  if (b.low >= 0) return b;
  const Fact other = negate(b);
  if (b.high <= 0) return other;
  return {b.known, b.whole, 0, std::max(b.high, other.high)};
}

Fact minimum(const Fact& b, const Fact& c) {
  return {b.known && c.known, b.whole && c.whole, std::min(b.low, c.low), std::min(b.high, c.high)};
}

Fact maximum(const Fact& b, const Fact& c) {
  return {b.known && c.known, b.whole && c.whole, std::max(b.low, c.low), std::max(b.high, c.high)};
}

// For a constant step. The ends of the range are not multiples of it.
Fact round_to(const Fact& b, const Fact& c) {
  if (c.low != c.high || c.low <= 0) return {b.known && c.known};
  const Value low = vm::round_to(b.low, c.low);
  const Value high = vm::round_to(b.high, c.low);
  const bool whole = c.low % kScale == 0 && low > vm::kValueMin && high < vm::kValueMax;
  return {b.known && c.known, whole, low, high};
}

Fact random_between(const Fact& b, const Fact& c) {
  Fact result = either(b, c);
  result.whole = result.whole && result.low == result.high;
  return result;
}

Fact clamp(const Fact& b, Value min, Value max) {
  const bool keeps_low = b.low >= min || min % kScale == 0;
  const bool keeps_high = b.high <= max || max % kScale == 0;
  return {b.known, b.whole && keeps_low && keeps_high, std::clamp(b.low, min, max),
          std::clamp(b.high, min, max)};
}

Fact sum_of_up_to(Value times, const Fact& b) {
  const std::int64_t low = std::min<std::int64_t>(std::int64_t{b.low} * times, 0);
  const std::int64_t high = std::max<std::int64_t>(std::int64_t{b.high} * times, 0);
  return {b.known, b.whole && in_range(low) && in_range(high), cut_off(low), cut_off(high)};
}

// ---- truth values

Fact is_less(const Fact& b, const Fact& c) {
  return truth_of(b.known && c.known, b.low < c.high, b.high >= c.low);
}

Fact is_not_greater(const Fact& b, const Fact& c) {
  return truth_of(b.known && c.known, b.low <= c.high, b.high > c.low);
}

Fact is_equal(const Fact& b, const Fact& c) {
  const bool meet = b.low <= c.high && c.low <= b.high;
  const bool same = b.low == b.high && c.low == c.high && b.low == c.low;
  return truth_of(b.known && c.known, meet, !same);
}

Fact logical_not(const Fact& b) {
  return {b.known, false, vm::logical_not(b.high), vm::logical_not(b.low)};
}

// True is the least number, so AND is the greater of two known truth values, and OR the lesser.
Fact logical_and(const Fact& b, const Fact& c) {
  const auto is_false = [](const Fact& one) { return one.known && one.low == vm::kFalse; };
  return {(b.known && c.known) || is_false(b) || is_false(c), false, std::max(b.low, c.low),
          std::max(b.high, c.high)};
}

Fact logical_or(const Fact& b, const Fact& c) {
  return logical_not(logical_and(logical_not(b), logical_not(c)));
}

}  // namespace robosync::compiler
