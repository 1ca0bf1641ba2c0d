// Facts about a value that are proved before the program runs.
//
// A fact holds for every value that an expression can have: unless the value is unknown, it lies in low … high, and is a multiple
// of one if `whole`. `known`: it is never unknown. Truth values are numbers, too (vm/value.hpp). The functions below compute the
// fact of a result from those of its operands. They match vm/arithmetic.hpp exactly, including saturation.
#pragma once

#include "vm/value.hpp"

namespace robosync::compiler {

struct Fact {
  bool known = false;
  bool whole = false;
  vm::Value low = vm::kValueMin, high = vm::kValueMax;  // low <= high

  [[nodiscard]] bool is_constant() const { return known && low == high; }
  [[nodiscard]] bool lies_in(vm::Value least, vm::Value most) const {
    return low >= least && high <= most;
  }
  [[nodiscard]] bool never_true() const { return low > vm::kTrue; }
  bool operator==(const Fact&) const = default;
};

[[nodiscard]] Fact fact_of(vm::Value constant);
[[nodiscard]] Fact known_between(vm::Value low, vm::Value high, bool whole);
// The fact of a value that has one of the two facts.
[[nodiscard]] Fact either(const Fact& one, const Fact& other);

[[nodiscard]] Fact negate(const Fact& b);
[[nodiscard]] Fact add(const Fact& b, const Fact& c);
[[nodiscard]] Fact subtract(const Fact& b, const Fact& c);
[[nodiscard]] Fact multiply(const Fact& b, const Fact& c);
[[nodiscard]] Fact divide(const Fact& b, const Fact& c);
[[nodiscard]] Fact modulo(const Fact& b, const Fact& c);
[[nodiscard]] Fact absolute(const Fact& b);
[[nodiscard]] Fact minimum(const Fact& b, const Fact& c);
[[nodiscard]] Fact maximum(const Fact& b, const Fact& c);
[[nodiscard]] Fact round_to(const Fact& b, const Fact& c);
[[nodiscard]] Fact random_between(const Fact& b, const Fact& c);
[[nodiscard]] Fact clamp(const Fact& b, vm::Value min, vm::Value max);
// The sum of up to `times` values with this fact.
[[nodiscard]] Fact sum_of_up_to(vm::Value times, const Fact& b);

[[nodiscard]] Fact is_less(const Fact& b, const Fact& c);
[[nodiscard]] Fact is_not_greater(const Fact& b, const Fact& c);
[[nodiscard]] Fact is_equal(const Fact& b, const Fact& c);
[[nodiscard]] Fact logical_not(const Fact& b);
[[nodiscard]] Fact logical_and(const Fact& b, const Fact& c);
[[nodiscard]] Fact logical_or(const Fact& b, const Fact& c);

// True if no sum, or no product, overflows: the unchecked opcodes may be used.
[[nodiscard]] bool sum_fits(const Fact& b, const Fact& c);
[[nodiscard]] bool product_fits(const Fact& b, const Fact& c);

}  // namespace robosync::compiler
