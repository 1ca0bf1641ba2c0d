// The whole runtime of a board, as the firmware has it, but driven from inside: a given image is
// activated, and after a first reading of each channel, given ones of channel 0 are fed, between
// markers. For bench/growth.py, which compares how many rules fired.
//
// The thread that does it has the lowest rank. So when it comes back from feed(), the step is over,
// and everything that came of it is done.
#include <array>
#include <cstdint>

#include "bench/firmware/given.hpp"
#include "bench/firmware/mark.hpp"
#include "runtime-m4/boards/mps2-an386/board.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"
#include "runtime-m4/runtime.hpp"

robosync::kernel::Kernel robosync_kernel;
robosync::boards::mps2::Board robosync_board;

namespace robosync::bench {
namespace {

constexpr kernel::Duration kSettling = kernel::milliseconds(100);

// What happened since begin(). A board to which nobody listens counts nothing, so this
// adds a few instructions to each event.
class Counts final : public EventSink {
public:
  void emit(const link::Event& event) override {
    if (event.kind == link::EventKind::fire) ++fired_;
    if (event.kind == link::EventKind::command) ++commands_;
  }
  void begin() { fired_ = commands_ = 0; }
  void tell() const { say("step", std::array{fired_, commands_}); }

private:
  std::int32_t fired_ = 0;
  std::int32_t commands_ = 0;
};

Counts counts;
layers::Workspace workspace;
Runtime runtime(robosync_kernel, robosync_board, counts, workspace);
kernel::Thread thread;
alignas(port::kStackAlignment) std::array<std::byte, 2048> stack;

void load() {
  BENCH_MARK(load_begin);
  const vm::Verdict verdict = runtime.activate(given_image());
  BENCH_MARK(load_end);
  const std::array why = {static_cast<std::int32_t>(verdict.refusal),
                          static_cast<std::int32_t>(verdict.section),
                          static_cast<std::int32_t>(verdict.index)};
  if (verdict.ok()) return;
  say("refused", why);
  leave(false);
}

void feed(std::uint32_t channel, vm::Value reading) {
  const link::FeedResult result = runtime.feed({.at_us = 0, .channel = channel, .value = reading});
  if (result.error != link::FeedError::none) leave(false);
}

void settle() {
  robosync_kernel.sleep_until(robosync_kernel.now() + kSettling);
}

// The first reading of each channel: 0.
void feed_first() {
  for (std::uint32_t channel = 0; channel < runtime.image().channels.size(); ++channel) {
    BENCH_MARK(first_begin);
    feed(channel, 0);
    BENCH_MARK(first_end);
    settle();
  }
}

void drive(void*) {
  load();
  settle();
  feed_first();
  for (const vm::Value reading : given_readings()) {
    counts.begin();
    BENCH_MARK(step_begin);
    feed(0, reading);
    BENCH_MARK(step_end);
    counts.tell();
    settle();
  }
  leave(true);
}

bool start() {
  return runtime.start() && robosync_kernel.add(thread, {.name = "bench",
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
