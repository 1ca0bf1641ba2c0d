// See echoes.hpp. Nordic's nRF52833 Product Specification: GPIOTE, PPI, TIMER.
#include "runtime-m4/boards/microbit-v2/echoes.hpp"

#include <array>

#include "runtime-m4/boards/common/echo.hpp"
#include "runtime-m4/boards/common/edge_counter.hpp"
#include "runtime-m4/boards/common/inputs.hpp"
#include "runtime-m4/boards/microbit-v2/inputs.hpp"
#include "runtime-m4/boards/microbit-v2/pins.hpp"
#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit::echoes {

namespace {

using inputs::is_high, inputs::kEchoes, inputs::kInputs;

constexpr std::uint32_t kPulse = 12;  // microseconds

std::array<Echo, kEchoes> echoes;

std::array<EdgeCounter, vm::kMaxEncoders> counters;

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
  return static_cast<unsigned>(kEchoes + i);
}

void ignore_edges(std::size_t i) {
  gpiote::kInterruptOff.write(1U << edges(i));
  gpiote::configuration(edges(i)).write(gpiote::kOff);
  forget(gpiote::edge(edges(i)));
}

void heed_edges(std::size_t i) {
  gpiote::configuration(edges(i)).write(gpiote::edges_of(kInputs[i].chip));
  forget(gpiote::edge(edges(i)));
  gpiote::kInterruptOn.write(1U << edges(i));
}

// Of TIMER3, in microseconds. No echo ends on an input whose edges are counted.
std::uint32_t now_by(std::size_t i) {
  kEchoTimer.capture(end_of_pulse(i)).write(kDoIt);
  return kEchoTimer.value(end_of_pulse(i)).read();
}

// An edge of input i. True: its next ones are of no use.
bool is_over(std::size_t i) {
  const bool high = is_high(kInputs[i]);
  const std::uint32_t time = kEchoTimer.value(time_of_edge(i)).read();
  for (EdgeCounter& counter : counters) {
    if (!counter.counts(i)) continue;
    const std::uint16_t second = counter.second();
    return !counter.edge(high, second == vm::kNoSecondPin || inputs::is_high(second) != high, time);
  }
  return echoes[i].edge(high, time);
}

}  // namespace

void start() {
  kEchoTimer.width().write(Timer::k32Bits);
  kEchoTimer.prescaler().write(Timer::kMicroseconds);
  for (std::size_t i = 0; i < kEchoes; ++i) {
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
  if (i >= kEchoes || output == nullptr) return;
  const port::Alone alone;
  ignore_edges(i);
  if (echoes[i].begin(is_high(kInputs[i]))) {
    heed_edges(i);
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
  if (i >= kEchoes) return 0;
  const port::Alone alone;
  ignore_edges(i);
  gpiote::configuration(pulse(i)).write(gpiote::kOff);
  return echoes[i].take();
}

// An edge since the interrupt was switched off is in its event still, and counts.
bool take_edges(unsigned number, std::uint16_t a, std::uint8_t b, unsigned most, Turned& turned) {
  const std::size_t i = find_input(kInputs, a);
  if (i >= kEchoes) return false;
  const port::Alone alone;
  EdgeCounter& counter = counters[number];
  const bool begins = !counter.counts(i);
  const std::uint32_t now = now_by(i);
  if (begins) counter.begin(i, b, is_high(kInputs[i]), now);
  const bool all = counter.take(is_high(kInputs[i]), most, now, turned);
  turned.begun = begins;
  if (begins || !all) heed_edges(i);
  return all;
}

policy::EncoderCount edges_so_far(unsigned number) {
  const port::Alone alone;
  return counters[number].so_far();
}

void end_edges(unsigned number) {
  const port::Alone alone;
  EdgeCounter& counter = counters[number];
  for (std::size_t i = 0; i < kEchoes; ++i)
    if (counter.counts(i)) ignore_edges(i);
  counter.end();
}

// Clears the event before it reads the level: an edge in between interrupts again.
void on_edge() {
  const port::Alone alone;
  for (std::size_t i = 0; i < kEchoes; ++i) {
    if (gpiote::edge(edges(i)).read() == 0) continue;
    forget(gpiote::edge(edges(i)));
    if (is_over(i)) ignore_edges(i);
  }
}

}  // namespace robosync::boards::microbit::echoes
