// See pins.hpp.
#include "runtime-m4/boards/stm32l4/pins.hpp"

#include <array>

#include "runtime-m4/boards/stm32l4/wiring.hpp"

namespace robosync::boards::stm32l4::pins {

namespace {

using wiring::kEnable, wiring::kOutputs;

constexpr std::array<Timer, 4> kTimers{kTimer2, kTimer3, kTimer4, kTimer5};

constexpr std::uint32_t kFrame = 20'000;   // microseconds
constexpr std::uint32_t kShortPulse = 12;  // microseconds
constexpr std::uint32_t kPerMicrosecond = kClockHz / 1'000'000;

const Output* find(std::uint16_t pin) {
  for (const Output& output : kOutputs)
    if (output.pin == pin) return &output;
  return nullptr;
}

void set_function(const Output& output, std::uint32_t function) {
  output.port.function(output.bit).set_field(output.bit % 8, 4, function);
}

void start(const Timer& timer) {
  timer.prescaler().write(kPerMicrosecond - 1);
  timer.last().write(kFrame - 1);
  for (unsigned channel = 0; channel < Timer::kChannels; ++channel) {
    timer.compare(channel).write(0);
    timer.mode(channel).set_field(channel % 2, 8, Timer::kPulseFromNextPeriod);
    timer.enable().set_field(channel, 4, Timer::kOutput);
  }
  timer.event().write(Timer::kUpdate);  // loads the settings into the timer
  timer.control().write(Timer::kOn);
}

// Affects one channel: the others keep the pulses that they are set to.
void low_at_once(const Timer& timer, unsigned channel) {
  timer.mode(channel).set_field(channel % 2, 8, Timer::kPulse);
  timer.compare(channel).write(0);
}

void set(Port port, unsigned bit, bool high) {
  port.change().write(1U << (high ? bit : bit + 16));
}

// Sets the level before the pin becomes an output.
void hold_high(const Pin& pin) {
  set(pin.port, pin.bit, true);
  pin.port.pulls().set_field(pin.bit, 2, 0);
  pin.port.mode().set_field(pin.bit, 2, kModeOfOutput);
}

}  // namespace

// The timers are started first: when the pins switch to them, they are low.
void start() {
  hold_high({kEnable.port, kEnable.bit});
  for (const Pin& pin : wiring::kHeldHigh)
    hold_high(pin);
  rcc::give_clock(rcc::kApb1, rcc::kTimers2To5);
  for (const Timer& timer : kTimers)
    start(timer);
  for (const Output& output : kOutputs) {
    set_function(output, output.function);
    output.port.mode().set_field(output.bit, 2, kModeOfFunction);
    output.port.pulls().set_field(output.bit, 2, 0);
  }
}

void write(std::uint16_t pin, std::uint32_t pulse_us) {
  const Output* const output = find(pin);
  if (output == nullptr) return;
  const Timer& timer = output->timer;
  if (pulse_us == 0) return low_at_once(timer, output->channel);
  timer.mode(output->channel).set_field(output->channel % 2, 8, Timer::kPulseFromNextPeriod);
  timer.compare(output->channel).write(pulse_us);
}

// The pin is high until the count reaches `compare`; the value for the next period is 0. If the period would end during the
// pulse, it ends now: the timer's other pins then give one pulse a few microseconds early.
void pulse(std::uint16_t pin) {
  const Output* const output = find(pin);
  if (output == nullptr) return;
  const Timer& timer = output->timer;
  if (timer.count().read() + 2 * kShortPulse >= kFrame) timer.event().write(Timer::kUpdate);
  timer.mode(output->channel).set_field(output->channel % 2, 8, Timer::kPulse);
  timer.compare(output->channel).write(timer.count().read() + kShortPulse);
  timer.mode(output->channel).set_field(output->channel % 2, 8, Timer::kPulseFromNextPeriod);
  timer.compare(output->channel).write(0);
}

void hand_over(std::uint16_t pin, std::uint32_t function) {
  if (const Output* const output = find(pin)) set_function(*output, function);
}

void begin_select(std::uint16_t pin) {
  if (const Output* const output = find(pin)) hold_high({output->port, output->bit});
}

void take_back(std::uint16_t pin) {
  const Output* const output = find(pin);
  if (output == nullptr) return;
  set_function(*output, output->function);
  output->port.mode().set_field(output->bit, 2, kModeOfFunction);
}

void enable(std::uint16_t pin, bool on) {
  if (pin == kEnable.pin) set(kEnable.port, kEnable.bit, !on);
}

void select(std::uint16_t pin, bool on) {
  if (pin == kEnable.pin) return enable(pin, on);
  if (const Output* const output = find(pin)) set(output->port, output->bit, !on);
}

std::uint32_t read(std::uint16_t pin) {
  const Output* const output = find(pin);
  return output == nullptr ? 0 : output->timer.compare(output->channel).read();
}

void switch_off() {
  enable(kEnable.pin, false);
  for (const Timer& timer : kTimers)
    for (unsigned channel = 0; channel < Timer::kChannels; ++channel)
      low_at_once(timer, channel);
}

}  // namespace robosync::boards::stm32l4::pins
