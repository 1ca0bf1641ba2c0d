// The whole runtime of a board, as the firmware has it and with somebody who listens to its trace,
// driven from inside: a given image is activated, then readings are fed, channel and value in turn,
// between markers. tests/timing/paths.py counts what one reading costs up to the last command that
// comes of it.
//
// The thread that does it has the lowest rank, as the link has in the firmware. So when it comes
// back from feed(), the step is over, and everything that came of it is done.
#include <array>
#include <cstdint>

#include "bench/firmware/given.hpp"
#include "bench/firmware/mark.hpp"
#include "runtime-m4/boards/mps2-an386/board.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"
#include "runtime-m4/runtime.hpp"
#include "runtime-m4/update/trace_ring.hpp"

robosync::kernel::Kernel robosync_kernel;
robosync::boards::mps2::Board robosync_board;

namespace robosync::bench {
namespace {

constexpr kernel::Duration kSettling = kernel::milliseconds(50);

update::TraceRing ring(robosync_kernel);
Runtime runtime(robosync_kernel, robosync_board, ring);
kernel::Thread thread;
alignas(port::kStackAlignment) std::array<std::byte, 2048> stack;

// Sleeps, and reads the trace all the while: a full ring would make events cheaper.
void settle() {
  std::array<std::byte, link::kMaxPayload> payload{};
  link::MessageType type{};
  for (kernel::Duration slept = 0; slept < kSettling; slept += kernel::kTick) {
    while (ring.take(type, payload) != 0) {
    }
    robosync_kernel.sleep_until(robosync_kernel.now() + kernel::kTick);
  }
}

void feed(std::uint32_t channel, vm::Value reading) {
  const link::Feed feed{.at_us = 0, .channel = channel, .value = reading};
  BENCH_MARK(feed_begin);
  const link::FeedResult result = runtime.feed(feed);
  BENCH_MARK(feed_end);
  if (result.error != link::FeedError::none) leave(false);
}

void drive(void*) {
  ring.listen(true);
  const vm::Verdict verdict = runtime.activate(given_image());
  const std::array why = {static_cast<std::int32_t>(verdict.refusal),
                          static_cast<std::int32_t>(verdict.section),
                          static_cast<std::int32_t>(verdict.index)};
  if (!verdict.ok()) say("refused", why);
  if (!verdict.ok()) leave(false);
  settle();
  const auto readings = given_readings();
  for (std::size_t i = 0; i + 1 < readings.size(); i += 2) {
    feed(static_cast<std::uint32_t>(readings[i]), readings[i + 1]);
    settle();
  }
  leave(ring.lost() == 0);
}

bool start() {
  return runtime.start() && robosync_kernel.add(thread, {.name = "path",
                                                         .category = kernel::Category::system,
                                                         .priority = 0,
                                                         .entry = drive,
                                                         .argument = nullptr,
                                                         .stack = stack});
}

}  // namespace
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
