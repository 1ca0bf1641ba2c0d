// Products and quotients in thousandths.
//
// Exact, in a bounded number of 32-bit steps: on the M4, a 64-bit division would be a library call of
// several hundred instructions.
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
// The Value with this magnitude and sign; saturates.
constexpr Value with_sign(std::uint32_t size, bool negative) {
  const auto value = size > INT32_MAX ? kValueMax : static_cast<Value>(size);
  return negative ? -value : value;
}

// value / 1000 for value < 500 * 2^32, by the reciprocal of 125: the estimate is at most 3 too small,
// and its remainder (below 500) corrects it.
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

// size * 1000 / divisor, rounded to the nearest, for a small divisor; UINT32_MAX if it does not fit.
constexpr std::uint32_t divide_by_small(std::uint32_t size, std::uint32_t divisor) {
  const std::uint32_t whole = size / divisor;
  const std::uint32_t rest = size % divisor;
  if (whole >= kSmall) return UINT32_MAX;
  return whole * kScale + (rest * kScale + divisor / 2) / divisor;
}

// Like divide_by_small(), for a divisor of kSmall or more, so for a quotient up to 512,000. Dividing by
// the divisor's upper bits, rounded up, never gives too much; for a quotient q it gives less than
// q / 4097 + 1 too little. So less than 126 is missing after the first round, and less than 1.04 after
// the second.
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
  // From 2^31 * 1000 = 500 * 2^32 on, the quotient exceeds kValueMax.
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
