// See logo.hpp. Nordic's nRF52833 Product Specification: GPIOTE, PPI, TIMER. CODAL, the library under MakeCode and MicroPython,
// takes the time in the same way, but every 2 ms, and compares it with the longest of ten untouched ones, plus 10 %.
//
// Between two measurements the pin is low, so that the logo is empty when the next one begins.
#include "runtime-m4/boards/microbit-v2/logo.hpp"

#include <algorithm>
#include <limits>

#include "runtime-m4/boards/microbit-v2/clock.hpp"
#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit::logo {

namespace {

constexpr Pin kPin{1, 4};
constexpr unsigned kEdge = 6;   // of GPIOTE; echoes.cpp has the first ones
constexpr unsigned kJoins = 9;  // of PPI; echoes.cpp and microphone.cpp have the first ones

// In 1/16 us. A finger multiplies the time (mb2-touch, public firmware for this board: from less than 50 us to 2.5 ms).
constexpr std::uint32_t kMargin = 10 * 16;
constexpr std::uint32_t kNever = std::numeric_limits<std::uint16_t>::max();  // 4 ms

std::uint16_t usual;  // time of an untouched logo; 0: not known yet
bool touched;

void empty() {
  gpiote::configuration(kEdge).write(gpiote::kOff);
  kPin.configuration().write(Pin::kOutput);
}

bool charges() {
  return gpiote::configuration(kEdge).read() != gpiote::kOff;
}

// Setting up an edge may cause an event, which is forgotten.
void charge() {
  const port::Alone alone;
  kPin.configuration().write(Pin::kInput);
  gpiote::configuration(kEdge).write(gpiote::rising_edge_of(kPin));
  forget(gpiote::edge(kEdge));
  kClockTimer.capture(kLogoIsEmpty).write(kDoIt);
}

std::uint32_t charging_time() {
  if (gpiote::edge(kEdge).read() == 0) return kNever;
  const std::uint32_t time =
      kClockTimer.value(kLogoIsCharged).read() - kClockTimer.value(kLogoIsEmpty).read();
  return std::clamp<std::uint32_t>(time, 1, kNever);
}

// The usual time falls quickly, so a finger that was there from the start is noticed when it comes back, and rises slowly, for
// other things than fingers.
void judge(std::uint32_t time) {
  if (usual == 0) {
    if (time != kNever) usual = static_cast<std::uint16_t>(time);
    return;
  }
  const std::uint32_t before = usual;
  touched = time > kMargin + (touched ? before + before / 2 : 2 * before);
  if (time < before)
    usual = static_cast<std::uint16_t>(before - (before - time) / 4);
  else if (!touched)
    usual = static_cast<std::uint16_t>(before + (time - before) / 64);
}

}  // namespace

void start() {
  usual = 0;
  touched = false;
  kPin.set_low().write(kPin.mask());
  empty();
  ppi::join(kJoins, gpiote::edge(kEdge), kClockTimer.capture(kLogoIsCharged));
  ppi::kOn.write(1U << kJoins);
}

bool measure(std::int32_t& raw) {
  if (charges()) {
    judge(charging_time());
    empty();
  } else {
    charge();
  }
  raw = touched ? 1 : 0;
  return usual != 0;
}

}  // namespace robosync::boards::microbit::logo
