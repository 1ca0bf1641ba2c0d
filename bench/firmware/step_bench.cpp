// The whole runtime of a board, as in the firmware, but driven from inside (driven.hpp). After a first reading of each channel,
// feeds given readings of channel 0 between markers. bench/growth.py compares how many rules fired.
#include <array>
#include <cstdint>

#include "bench/firmware/driven.hpp"
#include "bench/firmware/given.hpp"
#include "bench/firmware/mark.hpp"
#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/kernel/kernel.hpp"

robosync::kernel::Kernel robosync_kernel;

namespace robosync::bench {
namespace {

constexpr kernel::Duration kSettling = kernel::milliseconds(100);

// Counts what happened since begin(), while it listens.
class Counts final : public EventSink {
public:
  Counts() : EventSink(false) {}
  void listen(bool on) { set_listening(on); }
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

// Pretends to be a board with more memory, so that programs of any size can be measured.
constexpr policy::BoardMemory kMemory = {
    .arena_begin = 0x2180'0000, .arena_bytes = 512 * 1024, .step_budget = 1'000'000};
Runtime runtime(robosync_kernel, robosync_board, counts, arena_at(kMemory), kMemory);

void load() {
  BENCH_MARK(load_begin);
  const vm::Verdict verdict = runtime.activate(given_image());
  BENCH_MARK(load_end);
  check(verdict);
}

void feed(std::uint32_t channel, vm::Value reading) {
  const link::FeedResult result = runtime.feed({.channel = channel, .at_us = 0, .value = reading});
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

// Without a listener: this is measured.
void feed_given() {
  for (const vm::Value reading : given_readings()) {
    BENCH_MARK(step_begin);
    feed(0, reading);
    BENCH_MARK(step_end);
    settle();
  }
}

// The same again with a listener, to check the results.
void feed_again() {
  counts.listen(true);
  for (const vm::Value reading : given_readings()) {
    counts.begin();
    feed(0, reading);
    counts.tell();
    settle();
  }
}

void drive(void*) {
  load();
  settle();
  feed_first();
  feed_given();
  feed_again();
  leave(true);
}

}  // namespace

bool start() {
  return start_driven(runtime, drive);
}

}  // namespace robosync::bench
