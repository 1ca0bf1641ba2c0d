// Runs the shipped kernel between markers: a thread of low rank wakes one of high rank, by itself
// and from an interrupt, and spins while the tick comes; then the woken one is without privileges
// ("open"), and two such take turns. First with few threads, then with 64.
//
// bench/bench.py reads the counts.
#include <array>
#include <cstdint>

#include "bench/firmware/mark.hpp"
#include "runtime-m4/kernel/calls.hpp"
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
  alignas(port::kOpenStackAlignment) std::array<std::byte, kStackBytes> stack;
};
std::array<Task, kernel::kMaxThreads> tasks;
unsigned used = 0;
Task* high = nullptr;
Task* open = nullptr;
Task* turning = nullptr;
kernel::Thread* woken = nullptr;  // by the interrupt

Task* add(const char* name, Category category, std::int16_t priority, void (*entry)(void*),
          bool privileged = true) {
  Task& task = tasks[used++];
  if (!robosync_kernel.add(task.thread, {.name = name,
                                         .category = category,
                                         .priority = priority,
                                         .entry = entry,
                                         .argument = nullptr,
                                         .stack = task.stack,
                                         .privileged = privileged})) {
    leave(false);
  }
  return &task;
}

void run_high(void*) {
  while (true) {
    BENCH_MARK(high_blocks);
    (void)robosync_kernel.wait(kGo);
    BENCH_MARK(high_runs);
  }
}

void run_open(void*) {
  while (true) {
    BENCH_MARK(open_blocks);
    (void)kernel::calls::wait(robosync_kernel, kGo);
    BENCH_MARK(open_runs);
  }
}

// Turns are taken by reports: the upper one waits for them.
void run_upper(void*) {
  while (true)
    (void)kernel::calls::wait(robosync_kernel, kGo);
}
void run_lower(void*) {
  while (true) {
    (void)kernel::calls::wait(robosync_kernel, kGo);
    for (unsigned i = 0; i < kRounds; ++i)
      kernel::calls::report(robosync_kernel);
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

void post_open() {
  BENCH_MARK(post_open);
  robosync_kernel.signal(open->thread, kGo);
  BENCH_MARK(low_runs_again);
}

void pend_open() {
  BENCH_MARK(pend_open);
  port::core::reg(kNvicIspr) = 1;
  asm volatile("dsb\n\tisb" ::: "memory");
  BENCH_MARK(low_runs_after_open);
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
  woken = &high->thread;
  for (unsigned i = 0; i < kRounds; ++i)
    pend();
  spin();
}

void measure_open() {
  for (unsigned i = 0; i < kRounds; ++i)
    post_open();
  woken = &open->thread;
  for (unsigned i = 0; i < kRounds; ++i)
    pend_open();
  robosync_kernel.signal(turning->thread, kGo);
}

void add_open() {
  open = add("open", Category::behavior, 40, run_open, false);
  Task* const upper = add("upper", Category::behavior, 31, run_upper, false);
  turning = add("lower", Category::behavior, 30, run_lower, false);
  robosync_kernel.watch(upper->thread, 0, kGo);
}

void run_low(void*) {
  measure();
  add_open();
  measure_open();
  BENCH_MARK(more_threads);
  while (used < kernel::kMaxThreads)
    add("sleeper", Category::sensor, 1, sleep_forever);
  robosync_kernel.sleep_until(robosync_kernel.now() + kernel::milliseconds(10));
  measure();
  measure_open();
  leave(true);
}

// The size of a control block, as a symbol.
void record_sizes() {
  asm volatile(".global size_tcb\n.equ size_tcb, %c0" ::"i"(sizeof(kernel::Thread)));
}

}  // namespace
}  // namespace robosync::bench

void bench_interrupt() {
  robosync_kernel.signal(*robosync::bench::woken, robosync::bench::kGo);
}

int main() {
  using namespace robosync::bench;
  record_sizes();
  high = add("high", Category::behavior, 50, run_high);
  add("low", Category::system, 0, run_low);
  robosync::port::core::enable_interrupt(0);
  robosync_kernel.run();
}
