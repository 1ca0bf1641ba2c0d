// Sleeping without ticks: the time is right when the core wakes, and does not drift against the
// clock. These scenarios need that no thread of lower rank spins.
#include <array>

#include "runtime-m4/port/cortex-m4/core.hpp"
#include "tests/runtime-m4/kernel/firmware/rig.hpp"

namespace {

namespace core = robosync::port::core;
using robosync::kernel::Time;

constexpr unsigned kTimer0Interrupt = 8;
struct TimerRegisters {  // CMSDK APB timer
  volatile std::uint32_t control, value, reload, interrupt;
};
TimerRegisters& timer() {
  return *reinterpret_cast<TimerRegisters*>(0x4000'0000);
}

constexpr std::int32_t kCountsPerTick = 25'000;
constexpr std::int32_t kCountsPerMicrosecond = 25;

volatile std::int32_t least = 0;
volatile std::int32_t most = 0;
volatile unsigned interrupts = 0;
volatile std::uint32_t interrupted_at = 0;  // microseconds

// How far the clock is ahead of the time, in counts: less than a tick, if the time is right.
std::int32_t ahead() {
  const auto lock = robosync_kernel.lock_interrupts();
  const auto time = static_cast<std::uint32_t>(robosync_kernel.now());
  return static_cast<std::int32_t>(robosync_kernel.clock() - time * kCountsPerMicrosecond);
}

void note_ahead() {
  const std::int32_t now = ahead();
  if (now < least) least = now;
  if (now > most) most = now;
}

void begin_notes() {
  const std::int32_t now = ahead();
  least = now;
  most = now;
  interrupts = 0;
}

void interrupt_after(std::uint32_t counts) {
  timer().control = 0;
  timer().reload = 0xFFFF'FFFF;
  timer().value = counts;
  timer().control = 0b1001;
}

// Lengths without a pattern, mostly short.
std::uint32_t drawn(unsigned round, std::uint32_t limit) {
  return 1 + (round * 2'654'435'761U >> 16) % limit;
}

void time_does_not_drift() {
  core::enable_interrupt(kTimer0Interrupt);
  rig::sleep_ms(1);
  begin_notes();
  for (unsigned round = 0; round < 60; ++round) {
    interrupt_after(drawn(round, 200'000));
    const Time due = robosync_kernel.now() + drawn(round + 1000, 15) * 1000;
    robosync_kernel.sleep_until(due);
    CHECK(robosync_kernel.now() >= due);
    note_ahead();
  }
  timer().control = 0;
  CHECK(interrupts > 20);
  CHECK(most - least < kCountsPerTick + kCountsPerTick / 10);
}

void handler_sees_the_time() {
  rig::sleep_ms(1);
  begin_notes();
  const auto before = static_cast<std::uint32_t>(robosync_kernel.now());
  interrupt_after(100 * kCountsPerTick);
  robosync_kernel.sleep_until(robosync_kernel.now() + 150'000);
  timer().control = 0;
  CHECK(interrupts == 1);
  CHECK(interrupted_at - before >= 99'000);
  CHECK(most - least < kCountsPerTick + kCountsPerTick / 10);
}

void idle_stack_suffices() {
  CHECK(robosync_kernel.idle().stack_used() < robosync_kernel.idle().stack().size());
}

constexpr rig::Scenario kScenarios[] = {
    {"the time does not drift over sleeps and interrupts of any length", time_does_not_drift},
    {"an interrupt in the midst of a long sleep sees the right time", handler_sees_the_time},
    {"the idle thread's stack is never full", idle_stack_suffices},
};

}  // namespace

void rig::interrupted_in_sleep() {
  interrupts = interrupts + 1;
  interrupted_at = static_cast<std::uint32_t>(robosync_kernel.now());
  note_ahead();
}

std::span<const rig::Scenario> rig::idle_scenarios() {
  return kScenarios;
}
