// Numbers on the robot: decimal fixed point and three-valued truth.
//
// A Value counts thousandths of the canonical unit of its dimension (dimensions.def), so 0.1 + 0.2
// is exactly 0.3. The range is ±2,147,483.647; all arithmetic saturates at it, so INT32_MIN is never
// the result of arithmetic and means "unknown". See docs/bytecode.md, "Values"; for programs,
// docs/language.md.
#pragma once

#include <cstdint>

namespace robosync::vm {

using Value = std::int32_t;

inline constexpr Value kScale = 1000;  // thousandths in one canonical unit
inline constexpr Value kValueMax = INT32_MAX;
inline constexpr Value kValueMin = -INT32_MAX;
inline constexpr Value kUnknown = INT32_MIN;  // never published, or stale

// Truth values, chosen so that Kleene's AND and OR are the bitwise ones:
// unknown & false = false, unknown | true = true; every other AND or OR with unknown is unknown.
inline constexpr Value kFalse = 0;
inline constexpr Value kTrue = -1;

}  // namespace robosync::vm
