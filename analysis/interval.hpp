// The bounds of a number, whatever happens. Unknown is less than every known value
// (vm/value.hpp), so the interval of a number that may be unknown begins there.
#pragma once

#include <span>

#include "vm/image.hpp"

namespace robosync::analysis {

struct Interval {
  vm::Value low = vm::kUnknown, high = vm::kValueMax;
  [[nodiscard]] bool may_be_unknown() const { return low == vm::kUnknown; }
  bool operator==(const Interval&) const = default;
};

[[nodiscard]] Interval hull(Interval a, Interval b);
// Its bounds once it is known.
[[nodiscard]] Interval known(Interval a);
// What an instruction without blocks, waits or output writes into its cell A.
[[nodiscard]] Interval result_of(const vm::Image& image, vm::Word word,
                                 std::span<const Interval> cells);

}  // namespace robosync::analysis
