// Sets of values, as intervals of them: what a lint knows about a condition or a CHECK.
#pragma once

#include <cstdint>
#include <vector>

#include "vm/value.hpp"

namespace robosync::compiler {

struct Interval {
  std::int64_t low = vm::kValueMin, high = vm::kValueMax;  // both inclusive
};
using Intervals = std::vector<Interval>;  // in any order; they may overlap

[[nodiscard]] Intervals without(const Intervals& values, const Interval& taken);
[[nodiscard]] Intervals without(Intervals values, const Intervals& taken);

}  // namespace robosync::compiler
