// Nothing of this is in the firmware: it is there so that no firmware can be built for a board that
// does not declare its costs.
#include "runtime-m4/boards/costs.hpp"

static_assert(robosync::boards::kCosts.instructions_per_ms() > 0);
