// Runs the shipped kernel between markers. A thread of low rank wakes one of high rank, itself and from an interrupt, with and
// without a deadline; yields to one that is already ready; takes a mutex; spins while the tick comes; sleeps; and sends a reading
// through a mailbox. Then the same with a woken thread that is unprivileged ("open"), and two such threads that take turns. There
// are 7, 16 and 64 threads, and all others sleep.
//
// bench/figures.py reads the counts.
#include <array>
#include <bit>
#include <cstdint>

#include "bench/firmware/mark.hpp"
#include "runtime-m4/kernel/calls.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/mailbox.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"

extern "C" {
robosync::kernel::Kernel robosync_kernel;
void bench_interrupt();
// There is no board here that could have work for the idle thread (port/cortex-m4/hooks.hpp).
volatile std::uint32_t robosync_has_work = 0;
void robosync_work_instead() {}
}

namespace robosync::port::hooks {

const std::uint32_t kTickCounts = 25'000;
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
  alignas(port::kUnprivilegedStackAlignment) std::array<std::byte, kStackBytes> stack;
};
std::array<Task, kernel::kMaxThreads> tasks;
unsigned used = 0;
unsigned first_sleeper = 0;
Task* high = nullptr;
Task* open = nullptr;
Task* turning = nullptr;
kernel::Thread* woken = nullptr;  // by the interrupt
Task* timed = nullptr;
Task* reader = nullptr;
constexpr std::size_t kArenaBytes = 4096;
alignas(layers::Memory::kArenaAlignment) std::array<std::byte, kArenaBytes> arena;
layers::Memory memory(arena, policy::BoardMemory{.arena_bytes = kArenaBytes});
layers::Mailboxes mailboxes(robosync_kernel);
kernel::Mutex mutex{Category::system};
kernel::Time common_deadline = 0;

Task* add(const char* name, Category category, std::int16_t priority, void (*entry)(void*),
          bool privileged = true) {
  Task& task = tasks[used++];
  if (!robosync_kernel.add(task.thread, {.name = name,
                                         .category = category,
                                         .priority = priority,
                                         .entry = entry,
                                         .argument = &task,
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

// The threads take turns by reports: the upper one waits for them.
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

// As run_high, but arms a deadline each time, and cancels it.
void run_timed(void*) {
  while (true) {
    const kernel::Time deadline = robosync_kernel.now() + kernel::milliseconds(1000);
    BENCH_MARK(timed_blocks);
    (void)robosync_kernel.wait(kGo, deadline);
    BENCH_MARK(timed_runs);
  }
}

// Each thread sleeps until a different time, so that the buckets of all wheels are in use; when signalled, until a common one.
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

// Takes a reading as the step thread does when a sensor's thread announces it.
void run_reader(void*) {
  vm::Value read = 0;
  while (true) {
    (void)robosync_kernel.wait(kGo);
    if (mailboxes.take_announced() != 0) read = mailboxes.value(0);
    asm volatile("" ::"r"(read));
    BENCH_MARK(reading_there);
  }
}

// The layout of layers::Reading, which only the sensor layer may create.
struct RawReading {
  kernel::Time time;
  vm::Value value;
  std::uint8_t channel;
};

// Mailboxes for one channel.
void start_mailboxes() {
  policy::Needs needs;
  needs.counts[policy::Count::channels] = 1;
  memory.lay_out(needs);
  mailboxes.start(memory);
}

void send_reading(unsigned round) {
  const vm::Channel wiring{};
  const RawReading raw{robosync_kernel.now(), static_cast<vm::Value>(round), 0};
  BENCH_MARK(reading_sent);
  if (mailboxes.post(std::bit_cast<layers::Reading>(raw), wiring)) {
    mailboxes.announce(1);
    robosync_kernel.signal(reader->thread, kGo);
  }
}

void pend() {
  BENCH_MARK(pend);
  port::core::reg(kNvicIspr) = 1;
  asm volatile("dsb\n\tisb" ::: "memory");
  BENCH_MARK(low_runs_after_interrupt);
}

// Both threads are ready, and the running one yields to the other. As no two threads have the same rank, that is the end of a
// lock under which a higher one has become ready.
[[gnu::noinline]] void yield_to(kernel::Thread& thread) {
  const auto lock = robosync_kernel.lock();
  robosync_kernel.signal(thread, kGo);
  BENCH_MARK(yields);
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

// 1 + 2 × 1,000,000 instructions between the markers, plus those of the ticks in the meantime.
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
    yield_to(high->thread);
  for (unsigned i = 0; i < kRounds; ++i)
    yield_to(open->thread);
  woken = &high->thread;
  for (unsigned i = 0; i < kRounds; ++i)
    pend();
  for (unsigned i = 0; i < kRounds; ++i)
    post_open();
  woken = &open->thread;
  for (unsigned i = 0; i < kRounds; ++i)
    pend_open();
  robosync_kernel.signal(turning->thread, kGo);
  for (unsigned i = 0; i < kRounds; ++i)
    post_timed();
  for (unsigned i = 0; i < kRounds; ++i)
    take_mutex();
  for (unsigned i = 0; i < kRounds; ++i)
    send_reading(i);
  spin();
  for (unsigned i = 0; i < kRounds; ++i)
    sleep_a_tick();
  BENCH_MARK(measured);
}

// Of 58 sleepers, one in the middle moves back and forth past another: the smallest change of the order.
void change_priority() {
  kernel::Thread& other = tasks[30].thread;
  kernel::Thread& thread = tasks[31].thread;
  robosync_kernel.set_priority(other, {3, 1});
  robosync_kernel.set_priority(thread, {4, 1});
  for (unsigned i = 0; i < kRounds; ++i) {
    const kernel::Priority priority{static_cast<std::int8_t>(i % 2 == 0 ? 2 : 4), 1};
    BENCH_MARK(set_priority);
    robosync_kernel.set_priority(thread, priority);
    BENCH_MARK(priority_set);
  }
}

// No thread has anything to do except this one, which waits up to a second each time.
[[gnu::noinline]] void idle() {
  BENCH_MARK(idle);
  robosync_kernel.sleep_until(robosync_kernel.now() + kernel::milliseconds(1000));
  BENCH_MARK(idled);
}

// All sleepers are due at one tick.
void wake_all() {
  common_deadline = robosync_kernel.now() + kernel::milliseconds(20);
  for (unsigned i = first_sleeper; i < used; ++i)
    robosync_kernel.signal(tasks[i].thread, kGo);
  BENCH_MARK(wake_all);
  robosync_kernel.sleep_until(common_deadline + kernel::milliseconds(10));
  BENCH_MARK(all_woken);
}

[[gnu::noinline]] void measure_with(unsigned threads) {
  BENCH_MARK(add);
  while (used < threads)
    add("sleeper", Category::sensor, 1, sleep_forever);
  BENCH_MARK(added);
  robosync_kernel.sleep_until(robosync_kernel.now() + kernel::milliseconds(10));
  measure();
}

void run_low(void*) {
  first_sleeper = used;
  idle();
  for (const unsigned threads : {7U, 16U, 64U})
    measure_with(threads);
  wake_all();
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
  robosync_kernel.signal(*robosync::bench::woken, robosync::bench::kGo);
}

int main() {
  using namespace robosync::bench;
  record_sizes();
  high = add("high", Category::behavior, 50, run_high);
  timed = add("timed", Category::behavior, 40, run_timed);
  start_mailboxes();
  reader = add("reader", Category::behavior, 38, run_reader);
  open = add("open", Category::behavior, 35, run_open, false);
  Task* const upper = add("upper", Category::behavior, 31, run_upper, false);
  turning = add("lower", Category::behavior, 30, run_lower, false);
  robosync_kernel.watch(upper->thread, 0, kGo);
  add("low", Category::system, 0, run_low);
  robosync::port::core::enable_interrupt(0);
  robosync_kernel.run();
}
