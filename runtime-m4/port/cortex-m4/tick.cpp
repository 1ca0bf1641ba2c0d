// The kernel's time. How much of it has passed is said by the free-running clock alone; SysTick
// only says when to look. So ticks that were late, or left out, are counted all the same, and
// nothing drifts.
//
// While all threads wait there are no ticks: the idle thread (switch.S) stops SysTick, sets the
// board's alarm for the tick at which the timers have something to do, and sleeps. Whatever wakes
// it, the ticks that have passed are counted before any interrupt is let in, so no handler and no
// thread ever sees an old time. Then, before any thread can run, the idle thread starts the ticks
// again where they belong, and has SysTick's handler wake who is due.
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

// The ticks that have passed since they were last counted.
[[gnu::noinline]] std::uint32_t count() {
  const std::uint32_t before = counted_to;
  const std::uint32_t ticks = (before - Machine::clock()) / hooks::kTickCounts;
  counted_to = before - ticks * hooks::kTickCounts;
  return ticks;
}

// SysTick strikes at every tick, where the clock says that it is. In two parts, because the length of
// all but the first may only be said when that of the first is loaded.
void begin_to_strike() {
  const std::uint32_t over = std::min(counted_to - Machine::clock(), hooks::kTickCounts - 1);
  core::reg(core::kSystRvr) = hooks::kTickCounts - over + kLate - 1;
  core::reg(core::kSystCvr) = 0;
  core::reg(core::kSystCsr) = kSysTickOn;
}
void go_on_striking() {
  for (unsigned i = 0; i < kLooks && core::reg(core::kSystCvr) == 0; ++i) {
  }
  core::reg(core::kSystRvr) = hooks::kTickCounts - 1;
}

}  // namespace

}  // namespace robosync::port

extern "C" {

[[gnu::cold]] void robosync_set_alarm();
[[gnu::cold]] void robosync_count_sleep();
[[gnu::cold]] void robosync_end_sleep();
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

// … when it was woken, before interrupts are let in: the tick is due, too …
void robosync_count_sleep() {
  using namespace robosync::port;
  robosync_kernel.pass(count());
  core::reg(core::kIcsr) = core::kIcsrSysTickSet;
}

// … and then, under a SwitchLock. What it has to do while SysTick loads is done meanwhile.
void robosync_end_sleep() {
  using namespace robosync::port;
  begin_to_strike();
  hooks::clear_alarm();
  go_on_striking();
}

void SysTick_Handler() {
  robosync_kernel.on_tick(robosync::port::count());
}

}  // extern "C"

void robosync::port::start_tick() {
  counted_to = Machine::clock();
  robosync_end_sleep();
}
