// Threads woken by interrupts: no wake-up is lost, whichever instruction is interrupted.
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "tests/runtime-m4/kernel/firmware/rig.hpp"

namespace {

namespace core = robosync::port::core;
using rig::Events;

constexpr unsigned kTimer0Interrupt = 8;
struct TimerRegisters {  // CMSDK APB timer
  volatile std::uint32_t control;
  volatile std::uint32_t value;
  volatile std::uint32_t reload;
  volatile std::uint32_t interrupt;
};
TimerRegisters& timer() {
  return *reinterpret_cast<TimerRegisters*>(0x4000'0000);
}
constexpr std::uint32_t kTimerOn = 0b1001;  // enable, interrupt

constexpr Events kPosted = 2;
constexpr Events kOwn = 4;
constexpr std::uint32_t kFull = 0xFFFF'FFFF;

rig::Thread* volatile waiter = nullptr;
volatile unsigned lost = 0;
volatile unsigned taken = 0;
volatile std::uint32_t longest_ticks = 0;

// One interrupt after `ticks` of 25 MHz, which signals kPosted to `waiter`. The timer then continues from
// kFull, so that it shows how long ago the interrupt was.
void post_after(std::uint32_t ticks) {
  timer().control = 0;
  timer().reload = kFull;
  timer().value = ticks;
  timer().control = kTimerOn;
}

// Delays that put the interrupt on every instruction within reach in the course of a test.
std::uint32_t delay(unsigned round) {
  return 1 + round * 7 % 397;
}

void interrupt_wakes() {
  waiter = &rig::conductor();
  core::enable_interrupt(kTimer0Interrupt);
  post_after(1000);
  CHECK(robosync_kernel.wait(kPosted, robosync_kernel.now() + 10'000) == kPosted);
}

constexpr unsigned kRounds = 4000;

// Signals and takes its own event all the time, while the interrupt signals another one: both
// change the same words.
void busy_taker(void* argument) {
  auto& self = *static_cast<rig::Thread*>(argument);
  for (unsigned round = 0; round < kRounds; ++round) {
    post_after(delay(round));
    unsigned tries = 0;
    do {
      robosync_kernel.signal(self, kOwn);
      robosync_kernel.wait(kOwn);
    } while (robosync_kernel.wait(kPosted, 0) == 0 && ++tries < 200);
    if (tries == 200) lost = lost + 1;
    taken = taken + 1;
  }
}

void no_event_is_lost() {
  lost = 0;
  taken = 0;
  waiter = &rig::start(0, 40, busy_taker);
  rig::sleep_ms(200);
  CHECK(taken == kRounds);
  CHECK(lost == 0);
}

// Waits for the interrupt, with and without a deadline, and records how late it runs.
void catcher(void*) {
  for (unsigned round = 0; round < kRounds; ++round) {
    post_after(delay(round));
    if (round % 2 == 0) {
      robosync_kernel.wait(kPosted);
    } else {
      while (robosync_kernel.wait(kPosted, robosync_kernel.now() + 1000) == 0) {
      }
    }
    const std::uint32_t late = kFull - timer().value;
    if (late > longest_ticks) longest_ticks = late;
    taken = taken + 1;
  }
}

void waits_for_own(void*) {
  while (true)
    robosync_kernel.wait(kOwn);
}

rig::Thread* volatile above = nullptr;

// Wakes the thread above, which waits again immediately; then computes for a while.
void waker(void*) {
  while (true) {
    robosync_kernel.signal(*above, kOwn);
    for (unsigned i = 0; i < 400; ++i)
      asm volatile("");
  }
}

// The thread that the interrupt wakes ranks between one that begins to wait and the one that would run next:
// whichever instruction of the switch is interrupted, the woken one must run next.
void woken_runs_next() {
  taken = 0;
  longest_ticks = 0;
  above = &rig::start(0, 49, waits_for_own);
  waiter = &rig::start(1, 45, catcher);
  rig::start(2, 40, waker);
  rig::sleep_ms(400);
  CHECK(taken == kRounds);
  CHECK(longest_ticks < 400);
}

// --- interrupts above the kernel's level ---

volatile bool measuring = false;
volatile unsigned measured = 0;
volatile std::uint32_t latest = 0;

// Instead of waking a thread, measures how long ago the timer expired. Then starts the next measurement.
void measure() {
  const std::uint32_t late = kFull - timer().value;
  if (late > latest) latest = late;
  measured = measured + 1;
  post_after(delay(measured) + 200);
}

// The worst of many interrupts of this priority, in ticks of 25 MHz.
std::uint32_t worst_lateness(std::uint32_t priority) {
  core::enable_interrupt(kTimer0Interrupt);
  reinterpret_cast<volatile std::uint8_t*>(core::kNvicIpr)[kTimer0Interrupt] =
      static_cast<std::uint8_t>(priority);
  measured = 0;
  latest = 0;
  measuring = true;
  post_after(1000);
  rig::sleep_ms(100);
  timer().control = 0;
  measuring = false;
  core::enable_interrupt(kTimer0Interrupt);  // at the kernel's level again
  CHECK(measured > 3000);
  return latest;
}

void sleeps(void*) {
  while (true)
    rig::sleep_ms(1);
}

// Interrupts that the kernel masks are delayed by at most its longest critical section; those above its level are not
// delayed by one tick more than when the kernel does nothing.
void urgent_interrupts() {
  const std::uint32_t floor = worst_lateness(0);
  above = &rig::start(0, 49, waits_for_own);
  rig::start(1, 48, sleeps);
  rig::start(2, 47, sleeps);
  rig::start(3, 40, waker);
  const std::uint32_t urgent = worst_lateness(0);
  const std::uint32_t held_off = worst_lateness(core::kKernelPriority);
  CHECK(urgent <= floor + 1);  // the two clocks are not in phase
  CHECK(held_off > floor + 8);
}

// The kernel's time against a second clock.
void tick_is_true() {
  constexpr std::uint32_t kSpan = 0xFFFF'FFFF;
  robosync_kernel.sleep_until(robosync_kernel.now() + 1);
  timer().control = 0;
  timer().reload = kSpan;
  timer().value = kSpan;
  timer().control = 1;
  rig::sleep_ms(100);
  const std::uint32_t ticks = kSpan - timer().value;
  timer().control = 0;
  CHECK(ticks > 2'500'000 - 2'500);
  CHECK(ticks < 2'500'000 + 2'500);
}

constexpr rig::Scenario kScenarios[] = {
    {"100 ms of the kernel are 100 ms of another clock", tick_is_true},
    {"an interrupt wakes a thread", interrupt_wakes},
    {"interrupts above the kernel's level are not held off by it", urgent_interrupts},
    {"interrupts while a thread changes its own events: none is lost", no_event_is_lost},
    {"interrupts during switches: the woken thread runs next", woken_runs_next},
};

}  // namespace

extern "C" void Timer0_Handler();
void Timer0_Handler() {
  timer().interrupt = 1;
  if (rig::all_sleep()) return rig::interrupted_in_sleep();
  if (measuring) return measure();
  robosync_kernel.signal(*waiter, kPosted);
}

std::span<const rig::Scenario> rig::interrupt_scenarios() {
  return kScenarios;
}
