// See driven.hpp.
#include "bench/firmware/driven.hpp"

#include <array>
#include <cstdint>

#include "bench/firmware/mark.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"

namespace robosync::bench {
namespace {

kernel::Thread thread;
alignas(port::kStackAlignment) std::array<std::byte, 2048> stack;

}  // namespace

bool start_driven(Runtime& runtime, void (*drive)(void*)) {
  return runtime.start() && robosync_kernel.add(thread, {.name = "driver",
                                                         .category = kernel::Category::system,
                                                         .priority = 0,
                                                         .entry = drive,
                                                         .argument = nullptr,
                                                         .stack = stack});
}

void check(const vm::Verdict& verdict) {
  if (verdict.ok()) return;
  say("refused", std::array{static_cast<std::int32_t>(verdict.refusal),
                            static_cast<std::int32_t>(verdict.section),
                            static_cast<std::int32_t>(verdict.index)});
  leave(false);
}

}  // namespace robosync::bench

namespace robosync::port::hooks {

void thread_faulted(kernel::Thread&, const link::Fault&) {
  bench::leave(false);
}
void fatal_fault(const link::Fault&) {
  bench::leave(false);
}

}  // namespace robosync::port::hooks

int main() {
  if (!robosync::bench::start()) robosync::bench::leave(false);
  robosync_kernel.run();
}
