// See clock.hpp. SysTick, which wakes the core on other boards, stops on this chip while the core sleeps.
#include "runtime-m4/boards/microbit-v2/clock.hpp"

namespace robosync::boards::microbit {

namespace {

constexpr unsigned kLooks = 100'000;  // some 10 ms; the crystal takes less than one
constexpr std::uint32_t kSlack = 8;   // counts until a write takes effect

}  // namespace

bool start_clock() {
  flash::kInstructionCache.write(flash::kOn);
  kClockTimer.width().write(Timer::k32Bits);
  kClockTimer.prescaler().write(Timer::kEachCount);
  kClockTimer.start().write(kDoIt);
  clock::kCrystalRuns.write(0);
  clock::kStartCrystal.write(kDoIt);
  for (unsigned i = 0; i < kLooks; ++i)
    if (clock::kCrystalRuns.read() != 0) return true;
  return false;
}

bool begin_alarm(std::uint32_t counts) {
  const std::uint32_t begin = counted();
  kClockTimer.value(kAlarm).write(begin + counts);
  forget(kClockTimer.reached(kAlarm));
  kClockTimer.interrupts_on().write(Timer::interrupt(kAlarm));
  return counted() - begin + kSlack >= counts;
}

void end_alarm() {
  kClockTimer.interrupts_off().write(Timer::interrupt(kAlarm));
  forget(kClockTimer.reached(kAlarm));
}

}  // namespace robosync::boards::microbit
