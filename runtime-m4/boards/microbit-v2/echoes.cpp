// See echoes.hpp. Nordic's nRF52833 Product Specification: GPIOTE, PPI, TIMER.
#include "runtime-m4/boards/microbit-v2/echoes.hpp"

#include <array>

#include "runtime-m4/boards/common/echo.hpp"
#include "runtime-m4/boards/common/inputs.hpp"
#include "runtime-m4/boards/microbit-v2/inputs.hpp"
#include "runtime-m4/boards/microbit-v2/pins.hpp"
#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit::echoes {

namespace {

using inputs::is_high, inputs::kInputs;

constexpr std::uint32_t kPulse = 12;  // microseconds

std::array<Echo, kInputs.size()> echoes;

// The channels of input i: two each of GPIOTE and PPI, for its edges and for the end of the pulse; and two of the timer, one
// that captures the time of an edge and one that ends the pulse.
constexpr unsigned edges(std::size_t i) {
  return static_cast<unsigned>(2 * i);
}
constexpr unsigned pulse(std::size_t i) {
  return static_cast<unsigned>(2 * i + 1);
}
constexpr unsigned time_of_edge(std::size_t i) {
  return static_cast<unsigned>(i);
}
constexpr unsigned end_of_pulse(std::size_t i) {
  return static_cast<unsigned>(kInputs.size() + i);
}

void ignore_edges(std::size_t i) {
  gpiote::kInterruptOff.write(1U << edges(i));
  gpiote::configuration(edges(i)).write(gpiote::kOff);
  forget(gpiote::edge(edges(i)));
}

}  // namespace

void start() {
  kEchoTimer.width().write(Timer::k32Bits);
  kEchoTimer.prescaler().write(Timer::kMicroseconds);
  for (std::size_t i = 0; i < kInputs.size(); ++i) {
    ppi::join(edges(i), gpiote::edge(edges(i)), kEchoTimer.capture(time_of_edge(i)));
    ppi::join(pulse(i), kEchoTimer.reached(end_of_pulse(i)), gpiote::set_low(pulse(i)));
    ppi::kOn.write(1U << edges(i) | 1U << pulse(i));
  }
  kEchoTimer.start().write(kDoIt);
}

// Edges from before the ping are discarded. The lock keeps interrupts out between the pulse's start and the setting of its end.
void ping(std::uint16_t trigger, std::uint16_t echo) {
  const std::size_t i = find_input(kInputs, echo);
  const Pin* const output = pins::chip_pin(trigger);
  if (i == kInputs.size() || output == nullptr) return;
  const port::Alone alone;
  ignore_edges(i);
  if (echoes[i].begin(is_high(kInputs[i]))) {
    gpiote::configuration(edges(i)).write(gpiote::edges_of(kInputs[i].chip));
    forget(gpiote::edge(edges(i)));
    gpiote::kInterruptOn.write(1U << edges(i));
  }
  gpiote::configuration(pulse(i)).write(gpiote::drives(*output));
  gpiote::set_high(pulse(i)).write(kDoIt);
  kEchoTimer.capture(end_of_pulse(i)).write(kDoIt);
  const Register end = kEchoTimer.value(end_of_pulse(i));
  end.write(end.read() + kPulse);
}

// Returns the pulse's pin to its port, which drives it low.
std::uint32_t take(std::uint16_t echo) {
  const std::size_t i = find_input(kInputs, echo);
  if (i == kInputs.size()) return 0;
  const port::Alone alone;
  ignore_edges(i);
  gpiote::configuration(pulse(i)).write(gpiote::kOff);
  return echoes[i].take();
}

// Clears the event before it reads the level: an edge in between interrupts again.
void on_edge() {
  const port::Alone alone;
  for (std::size_t i = 0; i < kInputs.size(); ++i) {
    if (gpiote::edge(edges(i)).read() == 0) continue;
    forget(gpiote::edge(edges(i)));
    if (echoes[i].edge(is_high(kInputs[i]), kEchoTimer.value(time_of_edge(i)).read()))
      ignore_edges(i);
  }
}

}  // namespace robosync::boards::microbit::echoes
