// The values that each input may have at any time: a reading may be unknown or whatever its channel gives,
// a variable its initial value or what responses set it to. Images must be verified.
#pragma once

#include "analysis/walk.hpp"

namespace robosync::analysis {

[[nodiscard]] Ranges ranges_of_inputs(const vm::Image& image);

}  // namespace robosync::analysis
