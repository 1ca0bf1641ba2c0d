// The kernel's time. How much of it has passed is said by the free-running clock alone; SysTick
// only says when to look. So ticks that were late, or left out, are counted all the same, and
// nothing drifts.
//
// While all threads wait there are no ticks: the idle thread (switch.S) stops SysTick, sets the
// board's alarm for the tick at which the timers have something to do, and sleeps. Whatever wakes
// it, the ticks that have passed are counted before any interrupt is let in, so no handler and no
// thread ever sees an old time. SysTick's handler, which runs before any thread does, starts the
// ticks again where they belong.
//
// SysTick never strikes before the clock says that the tick is over: it is set by kLate too late.
#include "runtime-m4/port/cortex-m4/tick.hpp"

#include <algorithm>

#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"
#include "runtime-m4/port/cortex-m4/machine.hpp"

namespace robosync::port {

namespace {

constexpr std::uint32_t kLate = 4;                    // counts of the clock
constexpr std::uint32_t kLongestSleep = 0x4000'0000;  // … of which 32 bits must hold all that pass
constexpr unsigned kLooks = 64;                       // SysTick is loaded within one count
constexpr std::uint32_t kSysTickOff = 6, kSysTickOn = 7;  // core clock, with its interrupt

std::uint32_t counted_to = 0;  // the clock, at the latest tick that is counted; it counts down

// The ticks that have passed since they were last counted, and the clock's counts after these.
struct Passed {
  std::uint32_t ticks, rest;
};
Passed count() {
  const std::uint32_t now = Machine::clock();
  const std::uint32_t passed = counted_to - now;
  const std::uint32_t ticks = passed / hooks::kTickCounts;
  const std::uint32_t rest = passed - ticks * hooks::kTickCounts;
  counted_to = now + rest;
  return {ticks, rest};
}

// SysTick strikes at every tick. `rest`: how much of the first one is over.
[[gnu::cold]] void strike_at_ticks(std::uint32_t rest) {
  core::reg(core::kSystRvr) = hooks::kTickCounts - rest + kLate - 1;
  core::reg(core::kSystCvr) = 0;
  core::reg(core::kSystCsr) = kSysTickOn;
  for (unsigned i = 0; i < kLooks && core::reg(core::kSystCvr) == 0; ++i) {
  }
  core::reg(core::kSystRvr) = hooks::kTickCounts - 1;
}

}  // namespace

void start_tick() {
  counted_to = Machine::clock();
  strike_at_ticks(0);
}

}  // namespace robosync::port

extern "C" {

void robosync_set_alarm();
void robosync_count_sleep();
void SysTick_Handler();

// Called by switch.S when the idle thread is about to sleep, under a SwitchLock.
void robosync_set_alarm() {
  using namespace robosync::port;
  const std::uint32_t longest = kLongestSleep / hooks::kTickCounts;
  const std::uint32_t ticks = std::min(robosync_kernel.ticks_to_next_work(), longest);
  const std::uint32_t passed = counted_to - Machine::clock();
  const std::uint32_t counts = ticks * hooks::kTickCounts;
  if (passed >= counts) return;  // SysTick strikes now
  core::reg(core::kSystCsr) = kSysTickOff;
  hooks::set_alarm(counts - passed + kLate);
}

// … and when it was woken, before interrupts are let in.
void robosync_count_sleep() {
  using namespace robosync::port;
  robosync_kernel.pass(count().ticks);
  hooks::clear_alarm();
  core::reg(core::kIcsr) = core::kIcsrSysTickSet;
}

void SysTick_Handler() {
  using namespace robosync::port;
  const Passed passed = count();
  if ((core::reg(core::kSystCsr) & 1U) == 0) [[unlikely]]
    strike_at_ticks(passed.rest);
  robosync_kernel.on_tick(passed.ticks);
}

}  // extern "C"
