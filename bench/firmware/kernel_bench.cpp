// Runs the shipped kernel between markers: a thread of low rank wakes one of high rank, by itself
// and from an interrupt, and spins while the tick comes; first with two threads, then with 64.
//
// bench/bench.py reads the counts.
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

void add(const char* name, Category category, std::int16_t priority, void (*entry)(void*)) {
  Task& task = tasks[used++];
  if (!robosync_kernel.add(task.thread, {.name = name,
                                         .category = category,
                                         .priority = priority,
                                         .entry = entry,
                                         .argument = nullptr,
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

void sleep_forever(void*) {
  while (true)
    (void)robosync_kernel.wait(kGo, robosync_kernel.now() + kernel::milliseconds(60'000));
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

[[gnu::noinline]] void set_priority(kernel::Thread& thread, kernel::Priority priority) {
  BENCH_MARK(set_priority);
  robosync_kernel.set_priority(thread, priority);
  BENCH_MARK(priority_set);
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

void measure() {
  for (unsigned i = 0; i < kRounds; ++i)
    post();
  for (unsigned i = 0; i < kRounds; ++i)
    pend();
  spin();
}

// Of 62 sleepers one that stands in the middle goes to and fro past another: the least change that
// changes the order.
void change_priority() {
  kernel::Thread& other = tasks[30].thread;
  kernel::Thread& thread = tasks[31].thread;
  robosync_kernel.set_priority(other, {3, 1});
  robosync_kernel.set_priority(thread, {4, 1});
  for (unsigned i = 0; i < kRounds; ++i) {
    const kernel::Priority priority{static_cast<std::int8_t>(i % 2 == 0 ? 2 : 4), 1};
    set_priority(thread, priority);
  }
}

void run_low(void*) {
  measure();
  BENCH_MARK(more_threads);
  while (used < kernel::kMaxThreads)
    add("sleeper", Category::sensor, 1, sleep_forever);
  robosync_kernel.sleep_until(robosync_kernel.now() + kernel::milliseconds(10));
  measure();
  change_priority();
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
  add("high", Category::behavior, 50, run_high);
  add("low", Category::system, 0, run_low);
  robosync::port::core::enable_interrupt(0);
  robosync_kernel.run();
}
