// See intervals.hpp.
#include "compiler/sema/intervals.hpp"

#include <algorithm>

namespace robosync::compiler {

Intervals without(const Intervals& values, const Interval& taken) {
  Intervals left;
  for (const Interval& one : values) {
    if (one.low < taken.low) left.push_back({one.low, std::min(one.high, taken.low - 1)});
    if (one.high > taken.high) left.push_back({std::max(one.low, taken.high + 1), one.high});
  }
  return left;
}

Intervals without(Intervals values, const Intervals& taken) {
  for (const Interval& one : taken)
    values = without(values, one);
  return values;
}

}  // namespace robosync::compiler
