// The firmware of any board: kernel, board, runtime and link, joined and started.
#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/boards/common/reset.hpp"
#include "runtime-m4/boards/memory.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"
#include "runtime-m4/runtime.hpp"
#include "runtime-m4/update/server.hpp"
#include "runtime-m4/update/trace_ring.hpp"

robosync::kernel::Kernel robosync_kernel;

extern "C" std::byte robosync_arena[];  // placed by the linker script

namespace {

// Constructed in this order.
robosync::update::TraceRing trace(robosync_kernel);
robosync::Runtime runtime(robosync_kernel, robosync_board, trace,
                          {robosync_arena, ROBOSYNC_ARENA_BYTES}, robosync::boards::kMemory);
robosync::update::Server server(robosync_kernel, robosync_board, runtime, trace);

static_assert(robosync::boards::kReceiveBuffer >= robosync::link::kReceiveWindow);

}  // namespace

namespace robosync::port::hooks {

void thread_faulted(kernel::Thread&, const link::Fault& fault) {
  server.report(fault);
}

void fatal_fault(const link::Fault& fault) {
  boards::reset_after(fault);
}

}  // namespace robosync::port::hooks

// A kernel without room for its first two threads is built wrong: main() then returns, and
// the board resets.
int main() {
  const robosync::link::Fault* const last_words = robosync::boards::last_fault();
  if (last_words != nullptr) server.report(*last_words);
  if (!runtime.start() || !server.start()) return 1;
  robosync_kernel.run();
}
