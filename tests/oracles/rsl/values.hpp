// Numbers and truths as docs/language.md has them: thousandths, rounded half away from zero, kept
// inside ±2,147,483.647; nothing stands for "unknown". Written anew, in 64 and 128 bits: none of
// vm/arithmetic.hpp. The one naive arithmetic of the tests, from vm/ to whole programs.
#pragma once

#include <cstdint>
#include <optional>

#include "vm/value.hpp"

namespace robosync::oracle {

using Number = std::optional<std::int64_t>;  // thousandths
using Truth = std::optional<bool>;

// A value as the robot keeps it, and back.
[[nodiscard]] Number number_of(vm::Value value);
[[nodiscard]] Truth truth_of(vm::Value value);
[[nodiscard]] vm::Value value_of(Number number);
[[nodiscard]] vm::Value value_of(Truth truth);

[[nodiscard]] Number add(Number a, Number b);
[[nodiscard]] Number subtract(Number a, Number b);
[[nodiscard]] Number multiply(Number a, Number b);
[[nodiscard]] Number divide(Number a, Number b);  // by 0: 0
[[nodiscard]] Number modulo(Number a, Number b);  // has the sign of b; by 0: 0
[[nodiscard]] Number negate(Number a);
[[nodiscard]] Number absolute(Number a);
[[nodiscard]] Number lesser(Number a, Number b);
[[nodiscard]] Number greater(Number a, Number b);
[[nodiscard]] Number to_multiple(Number a, Number of);  // the nearest; a itself unless above 0

// One of these as an operator on Values.
[[nodiscard]] inline auto on_values(Number (*operate)(Number, Number)) {
  return
      [operate](vm::Value a, vm::Value b) { return value_of(operate(number_of(a), number_of(b))); };
}

[[nodiscard]] Truth both(Truth a, Truth b);
[[nodiscard]] Truth either(Truth a, Truth b);
[[nodiscard]] Truth opposite(Truth a);

// Where RANDOM, PICK ONE and EVERY … TO draw from: Marsaglia's xorshift32 (13, 17, 5). Each
// behaviour has one of its own, which begins with a mixture (MurmurHash3's finalizer) of the
// program's seed and its number: from the most important one, with SAFETY rules in front as one
// behaviour if there are any. A number of n possible ones is the place ⌊state · n / 2^32⌋ among
// them, after one round for each draw.
class Chance {
public:
  Chance(std::uint32_t program_seed, std::uint32_t behavior);
  explicit Chance(std::uint32_t state) : state_(state) {}
  // From `a` to `b`, in whichever order, both included; nothing is drawn where one is unknown.
  [[nodiscard]] Number draw(Number a, Number b);
  [[nodiscard]] std::uint32_t state() const { return state_; }

private:
  std::uint32_t state_ = 0;
};

}  // namespace robosync::oracle
