#include "tests/oracles/rsl/values.hpp"

#include <algorithm>

namespace robosync::oracle {
namespace {

constexpr std::int64_t kMost = 2'147'483'647;
__extension__ using Wide = __int128;  // holds every product here

Number kept_inside(Wide value) {
  return static_cast<std::int64_t>(std::clamp<Wide>(value, -kMost, kMost));
}

// a / b, half away from zero.
Wide rounded(Wide a, Wide b) {
  const bool negative = (a < 0) != (b < 0);
  const Wide size = a < 0 ? -a : a;
  const Wide by = b < 0 ? -b : b;
  const Wide quotient = (2 * size + by) / (2 * by);
  return negative ? -quotient : quotient;
}

}  // namespace

Number number_of(vm::Value value) {
  return value == vm::kUnknown ? std::nullopt : Number(value);
}

Truth truth_of(vm::Value value) {
  return value == vm::kUnknown ? std::nullopt : Truth(value == vm::kTrue);
}

vm::Value value_of(Number number) {
  return number ? static_cast<vm::Value>(*number) : vm::kUnknown;
}

vm::Value value_of(Truth truth) {
  if (!truth) return vm::kUnknown;
  return *truth ? vm::kTrue : vm::kFalse;
}

Number add(Number a, Number b) {
  if (!a || !b) return std::nullopt;
  return kept_inside(Wide{*a} + *b);
}

Number subtract(Number a, Number b) {
  if (!a || !b) return std::nullopt;
  return kept_inside(Wide{*a} - *b);
}

Number multiply(Number a, Number b) {
  if (!a || !b) return std::nullopt;
  return kept_inside(rounded(Wide{*a} * *b, 1000));
}

Number divide(Number a, Number b) {
  if (!a || !b) return std::nullopt;
  if (*b == 0) return 0;
  return kept_inside(rounded(Wide{*a} * 1000, *b));
}

Number modulo(Number a, Number b) {
  if (!a || !b) return std::nullopt;
  if (*b == 0) return 0;
  const std::int64_t rest = *a % *b;
  return rest != 0 && (rest < 0) != (*b < 0) ? rest + *b : rest;
}

Number negate(Number a) {
  if (!a) return std::nullopt;
  return -*a;
}

Number absolute(Number a) {
  if (!a) return std::nullopt;
  return *a < 0 ? -*a : *a;
}

Number lesser(Number a, Number b) {
  if (!a || !b) return std::nullopt;
  return std::min(*a, *b);
}

Number greater(Number a, Number b) {
  if (!a || !b) return std::nullopt;
  return std::max(*a, *b);
}

Number to_multiple(Number a, Number of) {
  if (!a || !of) return std::nullopt;
  return *of > 0 ? kept_inside(rounded(*a, *of) * *of) : *a;
}

Truth both(Truth a, Truth b) {
  if (a == false || b == false) return false;
  if (!a || !b) return std::nullopt;
  return true;
}

Truth either(Truth a, Truth b) {
  return opposite(both(opposite(a), opposite(b)));
}

Truth opposite(Truth a) {
  if (!a) return std::nullopt;
  return !*a;
}

Chance::Chance(std::uint32_t program_seed, std::uint32_t behavior) {
  state_ = program_seed + (behavior + 1) * 0x9E37'79B9;
  state_ = (state_ ^ state_ >> 16) * 0x85EB'CA6B;
  state_ = (state_ ^ state_ >> 13) * 0xC2B2'AE35;
  state_ ^= state_ >> 16;
  if (state_ == 0) state_ = 1;
}

Number Chance::draw(Number a, Number b) {
  if (!a || !b) return std::nullopt;
  state_ ^= state_ << 13;
  state_ ^= state_ >> 17;
  state_ ^= state_ << 5;
  const std::int64_t least = std::min(*a, *b);
  const auto count = static_cast<std::uint64_t>(std::max(*a, *b) - least + 1);
  return least + static_cast<std::int64_t>(static_cast<Wide>(state_) * count >> 32);
}

}  // namespace robosync::oracle
