// The arithmetic of Values: saturating, three-valued, exact.
//
// The interpreter and the compiler's constant folding both use this, so host and robot agree bit for
// bit. If an operand is kUnknown, so is the result. Every other result is in kValueMin … kValueMax.
#pragma once

#include <cstdint>

#include "vm/value.hpp"
#if defined(__ARM_FEATURE_DSP)
#include <arm_acle.h>
#endif

namespace robosync::vm {

namespace detail {

// Sum and difference, saturated at INT32_MIN and INT32_MAX: one instruction on the M4.
constexpr std::int32_t cut_off(std::int64_t value) {
  if (value > INT32_MAX) return INT32_MAX;
  return value < INT32_MIN ? INT32_MIN : static_cast<std::int32_t>(value);
}
#if defined(__ARM_FEATURE_DSP)
inline std::int32_t cut_off_sum(std::int32_t b, std::int32_t c) {
  return __qadd(b, c);
}
inline std::int32_t cut_off_difference(std::int32_t b, std::int32_t c) {
  return __qsub(b, c);
}
#else
constexpr std::int32_t cut_off_sum(std::int32_t b, std::int32_t c) {
  return cut_off(std::int64_t{b} + c);
}
constexpr std::int32_t cut_off_difference(std::int32_t b, std::int32_t c) {
  return cut_off(std::int64_t{b} - c);
}
#endif

}  // namespace detail

// b + c, both known. Saturates the sum minus 1, so that the result cannot be kUnknown.
inline Value add_known(Value b, Value c) {
  return detail::cut_off_sum(detail::cut_off_sum(b - 1, c), 1);
}

inline Value add(Value b, Value c) {
  return b == kUnknown || c == kUnknown ? kUnknown : add_known(b, c);
}

// Wrapping negation turns kUnknown into itself.
constexpr Value negate(Value b) {
  return static_cast<Value>(0U - static_cast<std::uint32_t>(b));
}

// The range is symmetric, so this is exact wherever add() is.
inline Value subtract(Value b, Value c) {
  return add(b, negate(c));
}

// b * c of two numbers in thousandths, rounded half away from zero.
Value multiply(Value b, Value c);

// b / c of two numbers in thousandths, rounded half away from zero; anything / 0 is 0.
Value divide(Value b, Value c);

// b modulo c, with the sign of c, so that an angle modulo 360deg is never negative; modulo 0 is 0.
constexpr Value modulo(Value b, Value c) {
  if (b == kUnknown || c == kUnknown) return kUnknown;
  if (c == 0) return 0;
  const Value remainder = b % c;
  return remainder != 0 && (remainder ^ c) < 0 ? remainder + c : remainder;
}

// modulo() for a known b and c > 0.
constexpr Value modulo_positive(Value b, Value c) {
  const Value remainder = b % c;
  return remainder < 0 ? remainder + c : remainder;
}

// b / n for a whole n > 0, rounded half away from zero.
constexpr Value divide_by_whole(Value b, std::int32_t n) {
  if (b == kUnknown) return kUnknown;
  const auto size = static_cast<std::uint32_t>(b < 0 ? -b : b);
  const auto divisor = static_cast<std::uint32_t>(n);
  const auto quotient = static_cast<Value>((size + divisor / 2) / divisor);
  return b < 0 ? -quotient : quotient;
}

// The absolute value; the range is symmetric.
constexpr Value absolute(Value b) {
  return b < 0 ? negate(b) : b;
}

// The lesser and the greater value.
constexpr Value lesser(Value b, Value c) {
  return b < c ? b : c;  // unknown is less than every known value
}
constexpr Value greater(Value b, Value c) {
  if (b == kUnknown || c == kUnknown) return kUnknown;
  return b < c ? c : b;
}

// The multiple of c nearest to b, half away from zero; b itself unless c is above 0.
Value round_to(Value b, Value c);

// Sums and products of operands proved to be known and in range: the lower 32 bits.
constexpr Value add_unchecked(Value b, Value c) {
  return static_cast<Value>(static_cast<std::uint32_t>(b) + static_cast<std::uint32_t>(c));
}
constexpr Value multiply_unchecked(std::int32_t b, Value c) {
  return static_cast<Value>(static_cast<std::uint32_t>(b) * static_cast<std::uint32_t>(c));
}

constexpr Value logical_not(Value truth) {
  return truth == kUnknown ? kUnknown : ~truth;
}

constexpr Value truth(bool value) {
  return value ? kTrue : kFalse;
}

// Relations of two known values. The sign of the saturated difference, spread over the word, is kTrue
// or kFalse without a branch.
inline Value is_less(Value b, Value c) {
  return detail::cut_off_difference(b, c) >> 31;
}
inline Value is_greater(Value b, Value c) {
  return is_less(c, b);
}
inline Value is_not_less(Value b, Value c) {
  return ~is_less(b, c);
}
inline Value is_not_greater(Value b, Value c) {
  return ~is_less(c, b);
}
constexpr Value is_equal(Value b, Value c) {
  return truth(b == c);
}
constexpr Value is_not_equal(Value b, Value c) {
  return truth(b != c);
}

}  // namespace robosync::vm
