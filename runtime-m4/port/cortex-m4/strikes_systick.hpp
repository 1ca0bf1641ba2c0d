// SysTick on a board that has no other counter: it makes the tick interrupts, ends the core's sleep, and is the clock. For
// tick.cpp. Call these functions under a SwitchLock.
//
// SysTick counts down 24 bits and starts over. The upper bits of the clock are kept in memory: each read of the clock checks
// SysTick's own flag, which tells whether SysTick has started over since the last read. So the clock must be read at least
// once in each period: SysTick's handler does that, and no code holds it off for a tick. SysTick is not written while threads
// run, so no counts are lost. It is restarted for a sleep longer than a tick, and after such a sleep, at the cost of an
// error of a few counts.
#pragma once

#include <cstdint>

namespace robosync::port::strikes {

inline constexpr std::uint32_t kLongestSleep = 0x00FF'FFFF;  // counts; the range of SysTick

// As in strikes_counter.hpp.
void begin(std::uint32_t counts);
inline void go_on() {}
void sleep_for(std::uint32_t counts);
inline void wake() {}

}  // namespace robosync::port::strikes
