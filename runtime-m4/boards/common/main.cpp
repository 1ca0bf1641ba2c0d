// The firmware: kernel, board, runtime and link, joined and started.
#include "runtime-m4/boards/mps2-an386/board.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"
#include "runtime-m4/runtime.hpp"
#include "runtime-m4/update/server.hpp"
#include "runtime-m4/update/trace_ring.hpp"

robosync::kernel::Kernel robosync_kernel;
robosync::boards::mps2::Board robosync_board;

namespace {

// Constructed in this order, after the two above. The linker script says where they stand, for the
// MPU.
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

static_assert(robosync::boards::mps2::Uart::kBufferBytes >= robosync::update::kReceiveWindow);

}  // namespace

namespace robosync::port::hooks {

void thread_faulted(kernel::Thread&, const link::Fault& fault) {
  server.report(fault);
}

void fatal_fault(const link::Fault& fault) {
  boards::mps2::reset_after(fault);
}

}  // namespace robosync::port::hooks

// A kernel that has no place for its first two threads is not built right: main() then returns, and
// the board starts over.
int main() {
  if (robosync_board.last_words() != nullptr) server.report(*robosync_board.last_words());
  if (!runtime.start() || !server.start()) return 1;
  robosync_board.uart().notify(
      [](void*) { robosync_kernel.signal(server.thread(), server.kLineReady); }, nullptr);
  robosync_board.uart().start();
  robosync_kernel.run();
}
