// What each input may be at any time: a reading unknown or whatever its channel gives, a variable
// what it begins with and what responses set it to. Images must be verified.
#pragma once

#include "analysis/walk.hpp"

namespace robosync::analysis {

[[nodiscard]] Ranges ranges_of_inputs(const vm::Image& image);

}  // namespace robosync::analysis
