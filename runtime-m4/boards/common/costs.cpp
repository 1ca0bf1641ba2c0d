// This adds nothing to the firmware: it makes the build fail for a board that does not declare its
// costs.
#include "runtime-m4/boards/costs.hpp"

static_assert(robosync::boards::kCosts.instructions_per_ms() > 0);
