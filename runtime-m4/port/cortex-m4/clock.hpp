// A clock that counts down in 32 bits. There are three kinds of boards:
//
// * Boards with a free-running counter of the core's clock. The linker script gives its address (robosync_clock), and the board
//   starts it. SysTick only makes the tick interrupts (strikes_counter.hpp).
// * Boards that set ROBOSYNC_CLOCK_IS_CALLED in board.cmake: reading their counter takes more than one load, so the board
//   defines robosync_read_clock(). One count may be ROBOSYNC_CORE_COUNTS cycles of the core's clock.
// * Boards that set ROBOSYNC_CLOCK_IS_SYSTICK in board.cmake. They have SysTick only: it makes the tick interrupts, ends the
//   core's sleep, and is the counter (strikes_systick.hpp).
#pragma once

#include <cstdint>

#if defined(ROBOSYNC_CLOCK_IS_SYSTICK) || defined(ROBOSYNC_CLOCK_IS_CALLED)
extern "C" std::uint32_t robosync_read_clock();  // [privileged; any state of the machine]
#else
extern "C" const volatile std::uint32_t robosync_clock;
#endif

namespace robosync::port {

#if defined(ROBOSYNC_CORE_COUNTS)
inline constexpr std::uint32_t kCyclesPerCount = ROBOSYNC_CORE_COUNTS;
#else
inline constexpr std::uint32_t kCyclesPerCount = 1;
#endif

inline std::uint32_t read_clock() {
#if defined(ROBOSYNC_CLOCK_IS_SYSTICK) || defined(ROBOSYNC_CLOCK_IS_CALLED)
  return robosync_read_clock();
#else
  return robosync_clock;
#endif
}

}  // namespace robosync::port
