// The firmware of any board: kernel, board, runtime and link, joined and started.
#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/boards/common/reset.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"
#include "runtime-m4/runtime.hpp"
#include "runtime-m4/update/server.hpp"
#include "runtime-m4/update/trace_ring.hpp"

robosync::kernel::Kernel robosync_kernel;

namespace {

// Constructed in this order. The linker script says where they stand, for the MPU.
[[gnu::section(".bss.writable")]] robosync::layers::Workspace workspace;
robosync::update::TraceRing trace(robosync_kernel);
[[gnu::section(".bss.readable.0")]] robosync::Runtime runtime(robosync_kernel, robosync_board,
                                                              trace, workspace);
[[gnu::section(".bss.readable.1")]] robosync::update::Slots slots;
robosync::update::Server server(robosync_kernel, robosync_board, runtime, trace, slots);

// Two numbers for the linker script, which knows where `runtime` stands. No code.
[[gnu::used]] void tell_linker() {
  constexpr robosync::Runtime::Layout kLayout = robosync::Runtime::layout();
  asm(".global runtime_may_be_readable, runtime_readable\n"
      ".set runtime_may_be_readable, %c0\n"
      ".set runtime_readable, %c1" ::"i"(kLayout.may_be_readable),
      "i"(kLayout.readable));
}

static_assert(robosync::boards::kReceiveBuffer >= robosync::update::kReceiveWindow);

}  // namespace

namespace robosync::port::hooks {

void thread_faulted(kernel::Thread&, const link::Fault& fault) {
  server.report(fault);
}

void fatal_fault(const link::Fault& fault) {
  boards::reset_after(fault);
}

}  // namespace robosync::port::hooks

// A kernel that has no place for its first two threads is not built right: main() then returns, and
// the board starts over.
int main() {
  const robosync::link::Fault* const last_words = robosync::boards::last_fault();
  if (last_words != nullptr) server.report(*last_words);
  if (!runtime.start() || !server.start()) return 1;
  robosync_kernel.run();
}
