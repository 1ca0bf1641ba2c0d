// See strikes_systick.hpp.
#include "runtime-m4/port/cortex-m4/strikes_systick.hpp"

#include <algorithm>

#include "runtime-m4/port/cortex-m4/clock.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"
#include "runtime-m4/port/cortex-m4/register.hpp"
#include "runtime-m4/port/cortex-m4/systick.hpp"

namespace robosync::port::strikes {

namespace {

constexpr Register kControl{core::kSystCsr};
constexpr Register kReload{core::kSystRvr};
constexpr Register kCurrent{core::kSystCvr};
constexpr std::uint32_t kOn = 7;                 // core clock, with its interrupt
constexpr std::uint32_t kBegunAgain = 1U << 16;  // reached 0 since the last read of the flag
// SysTick is loaded within one count; an emulator may take longer.
constexpr unsigned kLooks = 100'000;
// Counts between reading the clock in restart() and the write to SysTick; restart() corrects for them.
constexpr std::uint32_t kBetween = 12;
// After at most this many counts, restart() has set the period that follows the first one.
constexpr std::uint32_t kShortest = 256;

// The clock reads `end` when SysTick reaches 0, which happens once in `period` counts.
std::uint32_t end = 0;
std::uint32_t period = 0;
std::uint32_t next_period = 0;
bool sleeps =
    true;  // started for a sleep, or never: its period does not end with a tick until begin() restarts it

// Call under Alone. The order matters: if the flag is clear, SysTick had not reached 0 when `left` was read. 0 is the
// first value of a period, when all of its counts are left.
std::uint32_t read() {
  std::uint32_t left = kCurrent.read();
  if (kControl.has(kBegunAgain)) {
    end -= period = next_period;
    left = kCurrent.read();
    if (left == 0) left = period;
  }
  return end + left;
}

// Starts a period of `counts`, followed by periods of `then`. Call under Alone.
void restart(std::uint32_t counts, std::uint32_t then) {
  const std::uint32_t now = read();
  kReload.write(counts - 1);
  kCurrent.write(0);
  kControl.write(kOn);
  period = counts;
  end = now - kBetween - counts;
  for (unsigned i = 0; i < kLooks && kCurrent.read() == 0; ++i) {
  }
  kReload.write(then - 1);
  next_period = then;
}

}  // namespace

void begin(std::uint32_t counts) {
  Alone alone;
  if (sleeps) restart(std::max(counts, kShortest), hooks::kTickCounts);
  sleeps = false;
}

// The longest period follows the sleep, so that no counts are lost if the core wakes up late.
void sleep_for(std::uint32_t counts) {
  if (counts <= hooks::kTickCounts) return;  // the next tick ends the sleep
  Alone alone;
  restart(counts, kLongestSleep);
  sleeps = true;
}

}  // namespace robosync::port::strikes

std::uint32_t robosync_read_clock() {
  robosync::port::Alone alone;
  return robosync::port::strikes::read();
}
