// The kernel's time. The free-running clock alone tells how much time has passed; SysTick only tells
// when to look. So ticks that are late or skipped are counted too, and time does not drift.
//
// While all threads are blocked there are no ticks: the idle thread (switch.S) stops SysTick, sets an
// alarm for the tick at which the timers have work, and sleeps. Whatever wakes it, the ticks that have
// passed are counted before any interrupt is taken, so no handler and no thread ever reads an old
// time. Then, before any thread can run, the idle thread restarts SysTick in phase with the ticks. Its
// handler is pending, and wakes the threads that are due.
//
// SysTick never fires before the clock says that the tick is over: it is set kLate counts late.
#include "runtime-m4/port/cortex-m4/tick.hpp"

#include <algorithm>

#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"
#include "runtime-m4/port/cortex-m4/machine.hpp"
#if defined(ROBOSYNC_CLOCK_IS_SYSTICK)
#include "runtime-m4/port/cortex-m4/strikes_systick.hpp"
#else
#include "runtime-m4/port/cortex-m4/strikes_counter.hpp"
#endif

namespace robosync::port {

namespace {

constexpr std::uint32_t kLate = 4;  // counts of the clock

std::uint32_t counted_to = 0;  // the clock at the latest tick that has been counted

// Counts and returns the ticks since the last call.
[[gnu::noinline]] std::uint32_t count() {
  const std::uint32_t before = counted_to;
  const std::uint32_t ticks = (before - Machine::clock()) / hooks::kTickCounts;
  counted_to = before - ticks * hooks::kTickCounts;
  return ticks;
}

// Starts SysTick, in phase with the ticks of the clock.
void begin_to_strike() {
  const std::uint32_t over = std::min(counted_to - Machine::clock(), hooks::kTickCounts - 1);
  strikes::begin(hooks::kTickCounts - over + kLate);
}

}  // namespace

}  // namespace robosync::port

extern "C" {

[[gnu::cold]] void robosync_set_alarm();
[[gnu::cold]] void robosync_count_sleep();
[[gnu::cold]] void robosync_end_sleep();
void SysTick_Handler();

// switch.S calls this before the idle thread sleeps, under a SwitchLock.
void robosync_set_alarm() {
  using namespace robosync::port;
  const std::uint32_t longest = strikes::kLongestSleep / hooks::kTickCounts;
  const std::uint32_t ticks = std::min(robosync_kernel.ticks_to_next_work(), longest);
  const std::uint32_t passed = counted_to - Machine::clock();
  const std::uint32_t counts = ticks * hooks::kTickCounts;
  if (passed >= counts) return;  // SysTick fires now
  strikes::sleep_for(counts - passed + kLate);
}

// switch.S calls this after the sleep, before interrupts are taken. It also pends the tick.
void robosync_count_sleep() {
  using namespace robosync::port;
  robosync_kernel.pass(count());
  core::reg(core::kIcsr) = core::kIcsrSysTickSet;
}

// switch.S calls this last, under a SwitchLock. strikes::wake() runs while SysTick loads.
void robosync_end_sleep() {
  using namespace robosync::port;
  begin_to_strike();
  strikes::wake();
  strikes::go_on();
}

void SysTick_Handler() {
  robosync_kernel.on_tick(robosync::port::count());
}

}  // extern "C"

void robosync::port::start_tick() {
  counted_to = Machine::clock();
  robosync_end_sleep();
}
