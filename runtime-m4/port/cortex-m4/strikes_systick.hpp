// SysTick on a board that has nothing else: it strikes, it ends the core's sleep, and it is the clock. For tick.cpp. All of
// it under a SwitchLock.
//
// SysTick counts 24 bits down, and begins again; what lies above is kept in memory, and a reading finds out from SysTick's
// own flag whether it has begun again since the last one. So it must be read at least once in each of its
// periods: SysTick's handler does, and nobody holds that off for a tick. While threads run it is never
// written, so nothing is lost. To sleep for longer than a tick, and when something ends such a sleep early, it is begun
// anew, which is exact but for a few counts.
#pragma once

#include <cstdint>

namespace robosync::port::strikes {

inline constexpr std::uint32_t kLongestSleep = 0x00FF'FFFF;  // counts; what SysTick can count

// As in strikes_counter.hpp.
void begin(std::uint32_t counts);
inline void go_on() {}
void sleep_for(std::uint32_t counts);
inline void wake() {}

}  // namespace robosync::port::strikes
