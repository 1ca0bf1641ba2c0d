// See clock.hpp. SysTick, which wakes the core on other boards, stops on this chip while the core sleeps.
#include "runtime-m4/boards/microbit-v2/clock.hpp"

namespace robosync::boards::microbit {

namespace {

constexpr unsigned kLooks = 100'000;  // some 10 ms; the crystal takes less than one
constexpr std::uint32_t kSlack = 8;   // counts until a write takes effect

}  // namespace

bool start_clock() {
  flash::kInstructionCache.write(flash::kOn);
  timer::kWidth.write(timer::k32Bits);
  timer::kPrescaler.write(0);
  timer::kStart.write(kDoIt);
  clock::kCrystalRuns.write(0);
  clock::kStartCrystal.write(kDoIt);
  for (unsigned i = 0; i < kLooks; ++i)
    if (clock::kCrystalRuns.read() != 0) return true;
  return false;
}

bool begin_alarm(std::uint32_t counts) {
  const std::uint32_t begin = counted();
  timer::kAlarm.value().write(begin + counts);
  forget(timer::kAlarm.reached());
  timer::kInterruptOn.write(timer::kAlarm.interrupt());
  return counted() - begin + kSlack >= counts;
}

void end_alarm() {
  timer::kInterruptOff.write(timer::kAlarm.interrupt());
  forget(timer::kAlarm.reached());
}

}  // namespace robosync::boards::microbit
