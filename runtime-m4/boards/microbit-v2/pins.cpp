// See pins.hpp. Each module plays one value for each of its channels, over and over, and fetches it anew for each period.
// Nordic does not specify when in the period before, so a new pulse comes one or two frames later.
//
// That is too late for a pin that is to go off: it is disconnected from its module, and its port drives it low. It is connected
// again only when the module is guaranteed to be low for it: otherwise it would begin in the middle of a pulse.
#include "runtime-m4/boards/microbit-v2/pins.hpp"

#include <array>

#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit::pins {

namespace {

struct Output {
  std::uint16_t pin;  // of the edge connector
  Pin chip;
  unsigned module, channel;
};
constexpr std::array kOutputs{Output{0, {0, 2}, 0, 0},   Output{1, {0, 3}, 0, 1},
                              Output{2, {0, 4}, 0, 2},   Output{12, {0, 12}, 0, 3},
                              Output{13, {0, 17}, 1, 0}, Output{14, {0, 1}, 1, 1}};
constexpr std::uint16_t kEnable = 16;
constexpr Pin kEnableChip{1, 2};
constexpr std::array kModules{kPwm0, kPwm1};

constexpr std::uint16_t kFrame = 20'000;  // microseconds
// Period ends after which a value is guaranteed to be in effect; one more than needed if the module fetches it a whole
// period early.
constexpr std::uint8_t kSettled = 3;

struct State {
  std::uint16_t wanted = 0;       // pulse, in microseconds
  std::uint8_t ended = kSettled;  // periods since it went off
  bool joined = false;            // the pin is connected to the module
};
std::array<State, kOutputs.size()> states;

using Values = std::array<volatile std::uint16_t, Pwm::kChannels>;
alignas(4) std::array<Values, kModules.size()> values;

volatile std::uint16_t& value_of(const Output& output) {
  return values[output.module][output.channel];
}

State& state_of(const Output& output) {
  return states[static_cast<std::size_t>(&output - kOutputs.data())];
}

const Output* find(std::uint16_t pin) {
  for (const Output& output : kOutputs)
    if (output.pin == pin) return &output;
  return nullptr;
}

void start(const Pwm& module, Values& its_values) {
  for (volatile std::uint16_t& value : its_values)
    value = Pwm::kNever;
  module.prescaler().write(Pwm::kMicroseconds);
  module.top().write(kFrame);
  module.decoder().write(Pwm::kValueEach);
  module.loop().write(Pwm::kMostLoops);
  module.shortcuts().write(Pwm::kPlayAgain);
  for (unsigned sequence = 0; sequence < Pwm::kSequences; ++sequence) {
    module.values(sequence).write(port::bus_address(its_values.data()));
    module.count(sequence).write(Pwm::kChannels);
    module.refresh(sequence).write(0);
    module.end_delay(sequence).write(0);
  }
  module.enable().write(Pwm::kOn);
  module.play().write(kDoIt);
}

// The value comes last: it takes effect at the beginning of a period, and the pin must be connected by then.
void give(const Output& output, State& state) {
  kModules[output.module].pin(output.channel).write(output.chip.number());
  state.joined = true;
  const bool always = state.wanted >= kFrame;
  value_of(output) =
      static_cast<std::uint16_t>(Pwm::kHighUntil | (always ? Pwm::kNever : state.wanted));
}

void low_at_once(const Output& output, State& state) {
  const Pwm& module = kModules[output.module];
  module.pin(output.channel).write(kNoPin);
  value_of(output) = Pwm::kNever;
  state.wanted = 0;
  if (!state.joined) return;
  state.joined = false;
  state.ended = 0;
  forget(module.period_ended());
  module.interrupt_on().write(Pwm::kPeriodEnds);
}

// True if another period has to end.
bool waits(const Output& output, State& state) {
  if (state.ended == kSettled) return false;
  if (++state.ended < kSettled) return true;
  if (state.wanted != 0) give(output, state);
  return false;
}

}  // namespace

// The enable pin is set high before it becomes an output, so that it never switches on in between.
void start() {
  kEnableChip.set_high().write(kEnableChip.mask());
  kEnableChip.configuration().write(Pin::kOutput);
  for (const Output& output : kOutputs) {
    output.chip.set_low().write(output.chip.mask());
    output.chip.configuration().write(Pin::kOutput);
    state_of(output) = {};
  }
  for (std::size_t i = 0; i < kModules.size(); ++i)
    start(kModules[i], values[i]);
}

void write(std::uint16_t pin, std::uint32_t pulse_us) {
  const Output* const output = find(pin);
  if (output == nullptr) return;
  State& state = state_of(*output);
  const port::Alone alone;
  if (pulse_us == 0) return low_at_once(*output, state);
  state.wanted = static_cast<std::uint16_t>(pulse_us);
  if (state.ended == kSettled) give(*output, state);
}

void let_go(std::uint16_t pin, Reads what) {
  if (const Output* const output = find(pin))
    output->chip.configuration().write(what == Reads::level ? Pin::kInputPulledUp : Pin::kAnalog);
}

void take_back(std::uint16_t pin) {
  if (const Output* const output = find(pin)) output->chip.configuration().write(Pin::kOutput);
}

void enable(std::uint16_t pin, bool on) {
  if (pin != kEnable) return;
  (on ? kEnableChip.set_low() : kEnableChip.set_high()).write(kEnableChip.mask());
}

void select(std::uint16_t pin, bool on) {
  if (const Pin* const chip = pin == kEnable ? &kEnableChip : chip_pin(pin))
    (on ? chip->set_low() : chip->set_high()).write(chip->mask());
}

void end_select(std::uint16_t pin) {
  if (const Pin* const chip = chip_pin(pin)) chip->set_low().write(chip->mask());
}

const Pin* chip_pin(std::uint16_t pin) {
  const Output* const output = find(pin);
  return output == nullptr ? nullptr : &output->chip;
}

std::uint32_t read(std::uint16_t pin) {
  const Output* const output = find(pin);
  return output == nullptr ? 0 : state_of(*output).wanted;
}

// Switching a module off releases its pins, even during a pulse.
void switch_off() {
  enable(kEnable, false);
  for (const Pwm& module : kModules)
    module.enable().write(0);
  for (const Output& output : kOutputs) {
    end_select(output.pin);
    low_at_once(output, state_of(output));
  }
}

void on_period_end() {
  const port::Alone alone;
  for (unsigned i = 0; i < kModules.size(); ++i) {
    const Pwm& module = kModules[i];
    if (module.period_ended().read() == 0) continue;
    forget(module.period_ended());
    bool waiting = false;
    for (const Output& output : kOutputs)
      if (output.module == i && waits(output, state_of(output))) waiting = true;
    if (!waiting) module.interrupt_off().write(Pwm::kPeriodEnds);
  }
}

}  // namespace robosync::boards::microbit::pins
