// The two vector tables. The second one is active while an unprivileged thread runs: such a thread may make supervisor calls,
// and switching away from it takes another path (port/cortex-m4/switch.S).
#include "runtime-m4/boards/common/vectors.hpp"

#include ROBOSYNC_BOARD_INTERRUPTS

using robosync::boards::kInterrupts;
using robosync::boards::kUsedInterrupts;
using Table = robosync::boards::Vectors<kInterrupts>;

extern "C" {
[[gnu::section(".vectors.0"),
  gnu::used]] alignas(robosync::boards::kVectorAlignment<kInterrupts>) extern const Table
    robosync_vectors = robosync::boards::vectors<kInterrupts>(kUsedInterrupts, true);
[[gnu::section(".vectors.1"),
  gnu::used]] alignas(robosync::boards::kVectorAlignment<kInterrupts>) extern const Table
    robosync_unprivileged_vectors = robosync::boards::vectors<kInterrupts>(kUsedInterrupts, false);
}
