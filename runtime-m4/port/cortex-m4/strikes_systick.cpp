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
constexpr std::uint32_t kBegunAgain = 1U << 16;  // since the flag was read
// It is loaded within one count; an emulator may need its time.
constexpr unsigned kLooks = 100'000;
// The counts between the reading of the clock in begin() and the write that it is corrected for.
constexpr std::uint32_t kBetween = 12;
// So many counts it takes at the most to say what comes behind the first strike.
constexpr std::uint32_t kShortest = 256;

// The clock stands at `end` when SysTick comes to 0, which it does once in `period` counts.
std::uint32_t end = 0;
std::uint32_t period = 0;
std::uint32_t next_period = 0;
bool sleeps =
    true;  // begun for a sleep, or never; what ends its period is no tick's end before it was begun again

// Alone. The order matters: when the flag is not set, it did not begin again before `left` was read. 0 is the first
// state of a period, and stands for all of its counts.
std::uint32_t read() {
  std::uint32_t left = kCurrent.read();
  if (kControl.has(kBegunAgain)) {
    end -= period = next_period;
    left = kCurrent.read();
    if (left == 0) left = period;
  }
  return end + left;
}

// A period of `counts`, and behind it periods of `then`. Alone.
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
  const Alone alone;
  if (sleeps) restart(std::max(counts, kShortest), hooks::kTickCounts);
  sleeps = false;
}

// Behind the sleep the longest period stands, so that nothing is lost when the core wakes up late.
void sleep_for(std::uint32_t counts) {
  if (counts <= hooks::kTickCounts) return;  // the next strike is what ends it
  const Alone alone;
  restart(counts, kLongestSleep);
  sleeps = true;
}

}  // namespace robosync::port::strikes

std::uint32_t robosync_read_clock() {
  const robosync::port::Alone alone;
  return robosync::port::strikes::read();
}
