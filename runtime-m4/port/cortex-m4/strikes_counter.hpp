// SysTick on a board that has a counter besides it, of the core's clock or of a part of that, and a timer that ends the core's
// sleep (hooks::set_alarm()). For tick.cpp. All of it under a SwitchLock.
#pragma once

#include <cstdint>

#include "runtime-m4/port/cortex-m4/core.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"
#include "runtime-m4/port/cortex-m4/systick.hpp"

namespace robosync::port::strikes {

inline constexpr std::uint32_t kLongestSleep =
    0x4000'0000;                        // counts; 32 bits must hold all that pass
inline constexpr unsigned kLooks = 64;  // SysTick is loaded within one count
#if defined(ROBOSYNC_CORE_COUNTS)
inline constexpr std::uint32_t kCoreCounts = ROBOSYNC_CORE_COUNTS;
#else
inline constexpr std::uint32_t kCoreCounts = 1;
#endif
inline constexpr std::uint32_t kSysTickOff = 6, kSysTickOn = 7;  // core clock, with its interrupt

// SysTick strikes after so many counts, and from then on at every tick. In two parts, because the length of
// all but the first may only be said when that of the first is loaded.
inline void begin(std::uint32_t counts) {
  core::reg(core::kSystRvr) = counts * kCoreCounts - 1;
  core::reg(core::kSystCvr) = 0;
  core::reg(core::kSystCsr) = kSysTickOn;
}
inline void go_on() {
  for (unsigned i = 0; i < kLooks && core::reg(core::kSystCvr) == 0; ++i) {
  }
  core::reg(core::kSystRvr) = hooks::kTickCounts * kCoreCounts - 1;
}

// The core is about to sleep: no strikes, and an alarm after so many counts.
inline void sleep_for(std::uint32_t counts) {
  core::reg(core::kSystCsr) = kSysTickOff;
  hooks::set_alarm(counts);
}
// … and something has ended its sleep.
inline void wake() {
  hooks::clear_alarm();
}

}  // namespace robosync::port::strikes
