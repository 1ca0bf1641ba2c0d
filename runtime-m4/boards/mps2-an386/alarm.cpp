// The dual timer, in one-shot mode, ends the core's sleep. SysTick would do, but in QEMU 7.2 a timer that
// restarts while the core sleeps skips its whole next period (with sleep=off).
#include "runtime-m4/boards/mps2-an386/registers.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"

namespace robosync::port::hooks {

namespace mps2 = boards::mps2;

void set_alarm(std::uint32_t counts) {
  auto& timer = mps2::at<mps2::OneShotRegisters>(mps2::kDualTimer);
  timer.control = mps2::kOneShot;
  timer.load = counts;
  timer.control = mps2::kOneShotOn;
  core::enable_interrupt(mps2::kDualTimerInterrupt, core::kSwitchPriority);
}

void clear_alarm() {
  auto& timer = mps2::at<mps2::OneShotRegisters>(mps2::kDualTimer);
  timer.control = 0;
  timer.interrupt_clear = 1;
  core::clear_interrupt(mps2::kDualTimerInterrupt);
}

}  // namespace robosync::port::hooks
