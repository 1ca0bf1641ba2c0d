// Runs the shipped kernel between markers: a thread of low rank wakes one of high rank, by itself
// and from an interrupt, with and without a deadline, takes a mutex, spins while
// the tick comes and sleeps; among 4, 16 and 64 threads, all others of which sleep.
//
// bench/figures.py reads the counts.
#include <array>
#include <cstdint>

#include "bench/firmware/mark.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"

extern "C" {
robosync::kernel::Kernel robosync_kernel;
void bench_interrupt();
}

namespace robosync::port::hooks {

const std::uint32_t kCoreHz = 25'000'000;
void thread_faulted(kernel::Thread&, const link::Fault&) {
  bench::leave(false);
}
void fatal_fault(const link::Fault&) {
  bench::leave(false);
}

}  // namespace robosync::port::hooks

namespace robosync::bench {
namespace {

using kernel::Category;

constexpr unsigned kRounds = 32;
constexpr std::size_t kStackBytes = 512;
constexpr kernel::Events kGo = 1;
constexpr std::uintptr_t kNvicIspr = 0xE000E200;  // interrupt set-pending

struct Task {
  kernel::Thread thread;
  alignas(8) std::array<std::byte, kStackBytes> stack;
};
std::array<Task, kernel::kMaxThreads> tasks;
unsigned used = 0;
Task* high = nullptr;
Task* timed = nullptr;
kernel::Mutex mutex{Category::system};
kernel::Time common_deadline = 0;

void add(const char* name, Category category, std::int16_t priority, void (*entry)(void*)) {
  Task& task = tasks[used++];
  if (!robosync_kernel.add(task.thread, {.name = name,
                                         .category = category,
                                         .priority = priority,
                                         .entry = entry,
                                         .argument = &task,
                                         .stack = task.stack})) {
    leave(false);
  }
}

void run_high(void*) {
  while (true) {
    BENCH_MARK(high_blocks);
    (void)robosync_kernel.wait(kGo);
    BENCH_MARK(high_runs);
  }
}

// The same, but each time it arms a deadline, and takes it back.
void run_timed(void*) {
  while (true) {
    const kernel::Time deadline = robosync_kernel.now() + kernel::milliseconds(1000);
    BENCH_MARK(timed_blocks);
    (void)robosync_kernel.wait(kGo, deadline);
    BENCH_MARK(timed_runs);
  }
}

// Each for another time, so that the buckets of all wheels are in use; when called, until one they
// have in common.
void sleep_forever(void* self) {
  const auto number = static_cast<std::uint32_t>(static_cast<Task*>(self) - tasks.data());
  while (true) {
    (void)robosync_kernel.wait(kGo,
                               robosync_kernel.now() + kernel::milliseconds(2000 + 977 * number));
    robosync_kernel.sleep_until(common_deadline);
  }
}

void post() {
  BENCH_MARK(post);
  robosync_kernel.signal(high->thread, kGo);
  BENCH_MARK(low_runs);
}

void pend() {
  BENCH_MARK(pend);
  port::core::reg(kNvicIspr) = 1;
  asm volatile("dsb\n\tisb" ::: "memory");
  BENCH_MARK(low_runs_after_interrupt);
}

void post_timed() {
  BENCH_MARK(post_timed);
  robosync_kernel.signal(timed->thread, kGo);
  BENCH_MARK(low_runs_after_timed);
}

void take_mutex() {
  BENCH_MARK(mutex_begin);
  robosync_kernel.acquire(mutex);
  robosync_kernel.release(mutex);
  BENCH_MARK(mutex_end);
}

void sleep_a_tick() {
  const kernel::Time deadline = robosync_kernel.now() + kernel::kTick;
  robosync_kernel.sleep_until(deadline);
  BENCH_MARK(sleeper_runs);
}

// 1 + 2 × 1,000,000 instructions between the markers, plus what the ticks that come meanwhile take.
void spin() {
  unsigned rounds = 1'000'000;
  asm volatile(
      ".global mark_spin_begin, mark_spin_end\n"
      "mark_spin_begin: nop\n\t1: subs %0, #1\n\tbne 1b\n"
      "mark_spin_end:"
      : "+r"(rounds)
      :
      : "cc");
}

[[gnu::noinline]] void measure() {
  BENCH_MARK(measure);
  for (unsigned i = 0; i < kRounds; ++i)
    post();
  for (unsigned i = 0; i < kRounds; ++i)
    pend();
  for (unsigned i = 0; i < kRounds; ++i)
    post_timed();
  for (unsigned i = 0; i < kRounds; ++i)
    take_mutex();
  spin();
  for (unsigned i = 0; i < kRounds; ++i)
    sleep_a_tick();
  BENCH_MARK(measured);
}

// All sleepers are due at one tick.
void wake_all() {
  common_deadline = robosync_kernel.now() + kernel::milliseconds(20);
  for (unsigned i = 3; i < used; ++i)
    robosync_kernel.signal(tasks[i].thread, kGo);
  BENCH_MARK(wake_all);
  robosync_kernel.sleep_until(common_deadline + kernel::milliseconds(10));
  BENCH_MARK(all_woken);
}

void measure_with(unsigned threads) {
  while (used < threads)
    add("sleeper", Category::sensor, 1, sleep_forever);
  robosync_kernel.sleep_until(robosync_kernel.now() + kernel::milliseconds(10));
  measure();
}

void run_low(void*) {
  for (const unsigned threads : {4U, 16U, 64U})
    measure_with(threads);
  wake_all();
  leave(true);
}

// The size of a control block, as a symbol.
void record_sizes() {
  asm volatile(".global size_tcb\n.equ size_tcb, %c0" ::"i"(sizeof(kernel::Thread)));
}

}  // namespace
}  // namespace robosync::bench

void bench_interrupt() {
  robosync_kernel.signal(robosync::bench::high->thread, robosync::bench::kGo);
}

int main() {
  using namespace robosync::bench;
  record_sizes();
  high = &tasks[0];
  timed = &tasks[1];
  add("high", Category::behavior, 50, run_high);
  add("timed", Category::behavior, 40, run_timed);
  add("low", Category::system, 0, run_low);
  robosync::port::core::enable_interrupt(0);
  robosync_kernel.run();
}
