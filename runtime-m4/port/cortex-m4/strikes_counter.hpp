// SysTick on a board that also has a counter, of the core's clock or of a fraction of it, and a timer that ends the core's
// sleep (hooks::set_alarm()). For tick.cpp. Call these functions under a SwitchLock.
#pragma once

#include <cstdint>

#include "runtime-m4/port/cortex-m4/clock.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"
#include "runtime-m4/port/cortex-m4/systick.hpp"

namespace robosync::port::strikes {

inline constexpr std::uint32_t kLongestSleep =
    0x4000'0000;                        // counts; with a late wake-up still within 32 bits
inline constexpr unsigned kLooks = 64;  // SysTick is loaded within one count
inline constexpr std::uint32_t kSysTickOff = 6, kSysTickOn = 7;  // core clock, with its interrupt

// begin() makes SysTick fire after `counts`, and go_on() at every tick from then on. There are two functions because
// the reload value of the later periods may only be written after SysTick has loaded the first.
inline void begin(std::uint32_t counts) {
  core::reg(core::kSystRvr) = counts * kCyclesPerCount - 1;
  core::reg(core::kSystCvr) = 0;
  core::reg(core::kSystCsr) = kSysTickOn;
}
inline void go_on() {
  for (unsigned i = 0; i < kLooks && core::reg(core::kSystCvr) == 0; ++i) {
  }
  core::reg(core::kSystRvr) = hooks::kTickCounts * kCyclesPerCount - 1;
}

// The core is about to sleep: stops SysTick, and sets an alarm after `counts`.
inline void sleep_for(std::uint32_t counts) {
  core::reg(core::kSystCsr) = kSysTickOff;
  hooks::set_alarm(counts);
}
// An interrupt has ended the core's sleep.
inline void wake() {
  hooks::clear_alarm();
}

}  // namespace robosync::port::strikes
