// Makes the build fail for a board that does not declare its costs, and gives the firmware the one that it needs itself
// (asking_board.hpp).
#include "runtime-m4/boards/costs.hpp"

#include "runtime-m4/boards/common/asking_board.hpp"

static_assert(robosync::boards::kCosts.instructions_per_ms() > 0);

namespace robosync::boards {

const std::uint32_t kBusAheadMs = kCosts.bus_ahead_ms;

}  // namespace robosync::boards
