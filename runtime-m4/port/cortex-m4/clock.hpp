// The core's clock, counted down in 32 bits. Three kinds of boards:
//
// * Those with a free-running counter of that clock. The linker script says where it is (robosync_clock), the board
//   starts it. SysTick only strikes (strikes_counter.hpp).
// * Those that say ROBOSYNC_CLOCK_IS_CALLED in board.cmake: it takes more than one load to read theirs, so the board says
//   how. It may be slower than the core's clock, of which ROBOSYNC_CORE_COUNTS then make one count.
// * Those that say ROBOSYNC_CLOCK_IS_SYSTICK in board.cmake. There SysTick is all there is: it strikes, ends the core's
//   sleep, and is the counter (strikes_systick.hpp).
#pragma once

#include <cstdint>

#if defined(ROBOSYNC_CLOCK_IS_SYSTICK) || defined(ROBOSYNC_CLOCK_IS_CALLED)
extern "C" std::uint32_t robosync_read_clock();  // [privileged; any state of the machine]
#else
extern "C" const volatile std::uint32_t robosync_clock;
#endif

namespace robosync::port {

inline std::uint32_t read_clock() {
#if defined(ROBOSYNC_CLOCK_IS_SYSTICK) || defined(ROBOSYNC_CLOCK_IS_CALLED)
  return robosync_read_clock();
#else
  return robosync_clock;
#endif
}

}  // namespace robosync::port
