// See echoes.hpp. ST's RM0351, 14 (EXTI) and 9.2 (SYSCFG).
#include "runtime-m4/boards/stm32l4/echoes.hpp"

#include <array>

#include "runtime-m4/boards/common/echo.hpp"
#include "runtime-m4/boards/common/edge_counter.hpp"
#include "runtime-m4/boards/common/inputs.hpp"
#include "runtime-m4/boards/stm32l4/inputs.hpp"
#include "runtime-m4/boards/stm32l4/pins.hpp"

namespace robosync::boards::stm32l4::echoes {

namespace {

using inputs::is_high, wiring::kInputs;

std::array<Echo, kInputs.size()> echoes;

std::array<EdgeCounter, vm::kMaxEncoders> counters;

constexpr std::uint32_t kCountsPerUs = kClockHz / 1'000'000;

constexpr std::uint32_t line(std::size_t i) {
  return 1U << kInputs[i].bit;
}

// An edge of input i. True: its next ones are of no use.
bool is_over(std::size_t i, std::uint32_t now) {
  const bool high = is_high(kInputs[i]);
  for (EdgeCounter& counter : counters) {
    if (!counter.counts(i)) continue;
    const std::size_t second = counter.second();
    return !counter.edge(high, second == kInputs.size() || is_high(kInputs[second]) != high, now);
  }
  return echoes[i].edge(high, now);
}

}  // namespace

void start() {
  rcc::give_clock(rcc::kApb2, rcc::kSystemConfiguration);
  for (const Input& input : kInputs) {
    exti::port(input.bit).set_field(input.bit % 4, 4, number_of(input.port));
    exti::kMask.clear(1U << input.bit);
    exti::kRising.set(1U << input.bit);
    exti::kFalling.set(1U << input.bit);
  }
}

// Edges from before the ping are discarded.
void ping(std::uint16_t trigger, std::uint16_t echo) {
  const std::size_t i = find_input(kInputs, echo);
  if (i == kInputs.size()) return;
  const port::Alone alone;
  exti::kMask.clear(line(i));
  exti::kPending.write(line(i));
  if (echoes[i].begin(is_high(kInputs[i]))) exti::kMask.set(line(i));
  pins::pulse(trigger);
}

std::uint32_t take(std::uint16_t echo) {
  const std::size_t i = find_input(kInputs, echo);
  if (i == kInputs.size()) return 0;
  const port::Alone alone;
  exti::kMask.clear(line(i));
  return echoes[i].take() / kCountsPerUs;
}

// No interrupt comes meanwhile. The line is not masked for it: what comes then would be lost on a chip that discards edges of
// masked lines, as QEMU does. Edges from before it began are discarded.
bool take_edges(unsigned number, std::uint16_t a, std::uint8_t b, unsigned most, std::uint32_t now,
                Turned& turned) {
  const std::size_t i = find_input(kInputs, a);
  if (i == kInputs.size()) return false;
  const port::Alone alone;
  EdgeCounter& counter = counters[number];
  const bool begins = !counter.counts(i);
  if (begins) {
    exti::kPending.write(line(i));
    counter.begin(i, find_input(kInputs, b), is_high(kInputs[i]), now);
  }
  const bool all = counter.take(is_high(kInputs[i]), most, now, turned);
  turned.ago /= kCountsPerUs;
  turned.begun = begins;
  exti::kMask.set(line(i));
  return all;
}

policy::EncoderCount edges_so_far(unsigned number) {
  const port::Alone alone;
  return counters[number].so_far();
}

void end_edges(unsigned number) {
  const port::Alone alone;
  EdgeCounter& counter = counters[number];
  for (std::size_t i = 0; i < kInputs.size(); ++i)
    if (counter.counts(i)) exti::kMask.clear(line(i));
  counter.end();
}

// Clears the pending bit before it reads the level: an edge in between interrupts again.
void on_edge(std::uint32_t now) {
  const std::uint32_t pending = exti::kPending.read() & exti::kMask.read();
  for (std::size_t i = 0; i < kInputs.size(); ++i) {
    if ((pending & line(i)) == 0) continue;
    exti::kPending.write(line(i));
    if (is_over(i, now)) exti::kMask.clear(line(i));
  }
}

}  // namespace robosync::boards::stm32l4::echoes
