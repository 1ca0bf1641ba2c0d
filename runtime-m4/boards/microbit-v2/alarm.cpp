// The port's use of TIMER0: the clock, which it expects to count down, and the alarm that ends the core's sleep.
#include "runtime-m4/boards/microbit-v2/clock.hpp"
#include "runtime-m4/boards/microbit-v2/registers.hpp"
#include "runtime-m4/port/cortex-m4/clock.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"

std::uint32_t robosync_read_clock() {
  return ~robosync::boards::microbit::counted();
}

namespace robosync::port::hooks {

namespace microbit = boards::microbit;

void set_alarm(std::uint32_t counts) {
  const bool missed = microbit::begin_alarm(counts);
  core::enable_interrupt(microbit::kClockInterrupt, core::kSwitchPriority);
  if (missed) core::pend_interrupt(microbit::kClockInterrupt);
}

void clear_alarm() {
  microbit::end_alarm();
  core::clear_interrupt(microbit::kClockInterrupt);
}

}  // namespace robosync::port::hooks
