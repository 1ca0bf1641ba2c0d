// The whole runtime of a board, as the firmware has it and with somebody who listens to its trace,
// driven from inside (driven.hpp): readings are fed, channel and value in turn.
// tests/timing/paths.py counts what a reading costs, and what a tick does: when the thread that
// drives has woken after a tick, all that was due in that tick is done. A reading of kPause is
// none: it lets time pass, as many ticks as its channel says.
#include <array>
#include <cstdint>

#include "bench/firmware/driven.hpp"
#include "bench/firmware/given.hpp"
#include "bench/firmware/mark.hpp"
#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/update/trace_ring.hpp"

robosync::kernel::Kernel robosync_kernel;

namespace robosync::bench {
namespace {

constexpr std::uint32_t kSettling = 50;  // ticks
constexpr vm::Value kPause = INT32_MAX;

update::TraceRing ring(robosync_kernel);
Runtime runtime(robosync_kernel, robosync_board, ring, arena_at(boards::kMemory), boards::kMemory);

// Sleeps, and reads the trace all the while: a full ring would make events cheaper. It is read
// before a tick, so that reading is no part of what the tick does.
[[gnu::noinline]] void let_pass(std::uint32_t ticks) {
  std::array<std::byte, link::kMaxPayload> payload{};
  link::MessageType type{};
  for (std::uint32_t tick = 0; tick < ticks; ++tick) {
    while (ring.take(type, payload) != 0) {
    }
    robosync_kernel.sleep_until(robosync_kernel.now() + kernel::kTick);
    BENCH_MARK(woken);
  }
}

[[gnu::noinline]] void feed(std::uint32_t channel, vm::Value reading) {
  const link::Feed feed{.channel = channel, .at_us = 0, .value = reading};
  BENCH_MARK(feed_begin);
  const link::FeedResult result = runtime.enqueue(feed);
  BENCH_MARK(feed_end);
  if (result.error != link::FeedError::none) leave(false);
}

void drive(void*) {
  ring.listen(true);
  check(runtime.activate(given_image()));
  let_pass(kSettling);
  const auto readings = given_readings();
  for (std::size_t i = 0; i + 1 < readings.size(); i += 2) {
    const auto channel = static_cast<std::uint32_t>(readings[i]);
    if (readings[i + 1] == kPause) {
      let_pass(channel);
    } else {
      feed(channel, readings[i + 1]);
    }
  }
  let_pass(kSettling);
  leave(ring.lost() == 0);
}

}  // namespace

bool start() {
  return start_driven(runtime, drive);
}

}  // namespace robosync::bench
