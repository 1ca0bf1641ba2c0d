// Products and quotients in thousandths.
//
// Exact with 32-bit steps and a bounded number of them: on the M4, a 64-bit division would be a
// library call of several hundred instructions.
#include "vm/arithmetic.hpp"

namespace robosync::vm {
namespace {

constexpr std::uint32_t low(std::uint64_t value) {
  return static_cast<std::uint32_t>(value);
}
constexpr std::uint32_t high(std::uint64_t value) {
  return static_cast<std::uint32_t>(value >> 32);
}
constexpr std::uint32_t magnitude(Value known) {
  return known < 0 ? 0U - static_cast<std::uint32_t>(known) : static_cast<std::uint32_t>(known);
}
// The Value of this size and sign; sizes beyond the range saturate.
constexpr Value with_sign(std::uint32_t size, bool negative) {
  const auto value = size > INT32_MAX ? kValueMax : static_cast<Value>(size);
  return negative ? -value : value;
}

// value / 1000 for value < 500 * 2^32, by the reciprocal of 125: an estimate at most 3 too small,
// then its remainder (below 500) corrects it.
constexpr std::uint32_t divide_by_1000(std::uint64_t value) {
  constexpr std::uint32_t kReciprocal = (std::uint64_t{1} << 38) / 125;
  const std::uint32_t eighth = high(value) << 29 | low(value) >> 3;  // its lower 32 bits of 38
  const std::uint32_t top = high(value) << 23 | low(value) >> 9;     // its upper 32 bits
  const std::uint32_t estimate = high(std::uint64_t{top} * kReciprocal);
  const std::uint32_t remainder = eighth - estimate * 125;
  return estimate + (remainder * 525 >> 16);  // remainder / 125, exact below 500
}

// Numbers below this, times 1000, fit 32 bits with room for a rounding term.
constexpr std::uint32_t kSmall = 1 << 22;

// size * 1000 / divisor, rounded to the nearest, for a small divisor; UINT32_MAX when it does not
// fit.
constexpr std::uint32_t divide_by_small(std::uint32_t size, std::uint32_t divisor) {
  const std::uint32_t whole = size / divisor;
  const std::uint32_t rest = size % divisor;
  if (whole >= kSmall) return UINT32_MAX;
  return whole * kScale + (rest * kScale + divisor / 2) / divisor;
}

// The same for a divisor from kSmall on, so for a quotient up to 512,000. Dividing by the divisor's
// upper bits, rounded up, never gives too much; of a quotient q it leaves less than q / 4097 + 1.
// So less than 126 is missing after the first round and less than 1.04 after the second.
constexpr std::uint32_t divide_by_large(std::uint32_t size, std::uint32_t divisor) {
  const std::uint32_t upper = (divisor >> 10) + 1;
  std::uint64_t rest = std::uint64_t{size} * kScale + divisor / 2;
  std::uint32_t quotient = 0;
  for (int round = 0; round < 2; ++round) {
    const std::uint32_t part = low(rest >> 10) / upper;
    quotient += part;
    rest -= std::uint64_t{part} * divisor;
  }
  return rest < divisor ? quotient : quotient + 1;
}

}  // namespace

Value multiply(Value b, Value c) {
  if (b == kUnknown || c == kUnknown) return kUnknown;
  const bool negative = (b ^ c) < 0;
  const std::uint64_t rounded = std::uint64_t{magnitude(b)} * magnitude(c) + kScale / 2;
  // The quotient is beyond kValueMax from 2^31 * 1000 = 500 * 2^32 on.
  const bool fits = high(rounded) < kScale / 2;
  return with_sign(fits ? divide_by_1000(rounded) : UINT32_MAX, negative);
}

Value divide(Value b, Value c) {
  if (b == kUnknown || c == kUnknown) return kUnknown;
  if (c == 0) return 0;
  const bool negative = (b ^ c) < 0;
  const std::uint32_t divisor = magnitude(c);
  const std::uint32_t size = magnitude(b);
  return with_sign(
      divisor < kSmall ? divide_by_small(size, divisor) : divide_by_large(size, divisor), negative);
}

Value round_to(Value b, Value c) {
  if (b == kUnknown || c == kUnknown) return kUnknown;
  if (c <= 0) return b;
  const std::int64_t multiple = std::int64_t{divide_by_whole(b, c)} * c;
  if (multiple > kValueMax) return kValueMax;
  return multiple < kValueMin ? kValueMin : static_cast<Value>(multiple);
}

}  // namespace robosync::vm
