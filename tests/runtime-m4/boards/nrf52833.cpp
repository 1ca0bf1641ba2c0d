// See nrf52833.hpp.
#include "tests/runtime-m4/boards/nrf52833.hpp"

#include <algorithm>

namespace robosync::tests {
namespace {

constexpr std::array<std::uintptr_t, 4> kPwms{0x4001'C000, 0x4002'1000, 0x4002'2000, 0x4002'D000};
constexpr std::uintptr_t kWatchdog = 0x4001'0000, kResetReason = 0x4000'0400,
                         kRowTimer = 0x4000'9000;
constexpr std::uintptr_t kGpio = 0x5000'0000, kNextPort = 0x300;
constexpr std::uint32_t kPeriodEnds = 1U << 6;
constexpr std::uint32_t kDisconnected = 1U << 31;

bool is_port(std::uintptr_t address) {
  return address >= kGpio && address < kGpio + 0x1000;
}

// Both ports' registers are in one page, P1's 0x300 after P0's.
std::pair<unsigned, std::uintptr_t> of_port(std::uintptr_t address) {
  const std::uintptr_t offset = address - kGpio;
  for (const unsigned port : {0U, 1U}) {
    if (offset < kNextPort * port) continue;
    const std::uintptr_t own = offset - kNextPort * port;
    if ((own >= 0x504 && own <= 0x524) || (own >= 0x700 && own < 0x780)) return {port, own};
  }
  no_register(address);
}

}  // namespace

// The counter counts up from the beginning of the period to its end. A value with its highest bit set is high first, otherwise
// low first, and changes when the counter reaches it; never, if it is beyond the counter's top.
bool Nrf52833::Pwm::high(unsigned channel) const {
  const bool first = (at_work[channel] >> 15) != 0;
  const unsigned compare = at_work[channel] & 0x7FFF;
  demand(compare != 0 && compare != top, "Nordic does not say what this value does");
  return counter < compare ? first : !first;
}

std::optional<unsigned> Nrf52833::Pwm::channel_at(std::uint32_t pin) const {
  if (!enabled || !plays) return std::nullopt;
  std::optional<unsigned> found;
  for (unsigned channel = 0; channel < pins.size(); ++channel) {
    if ((pins[channel] & kDisconnected) != 0 || pins[channel] != pin) continue;
    demand(!found, "two channels of a module have a pin");
    demand(decoder != 3 || channel < 3, "the fourth value is no channel's");
    found = channel;
  }
  return found;
}

std::uint32_t Nrf52833::read(const Pwm& pwm, std::uintptr_t offset) const {
  if (offset == 0x118) return pwm.period_ended;
  if (offset == 0x304 || offset == 0x308) return pwm.interrupts;
  if (offset >= 0x560 && offset <= 0x56C) return pwm.pins[(offset - 0x560) / 4];
  no_register(offset);
}

void Nrf52833::configure(Pwm& pwm, std::uintptr_t offset, std::uint32_t value) {
  demand(!pwm.enabled, "a module is configured while it is on");
  Sequence& sequence = pwm.sequences[offset >= 0x540 ? 1 : 0];
  switch (offset) {
    case 0x504:
      pwm.mode = value;
      return;
    case 0x508:
      pwm.top = value & 0x7FFF;
      return;
    case 0x50C:
      pwm.prescaler = value & 7;
      return;
    case 0x510:
      pwm.decoder = value;
      return;
    case 0x514:
      pwm.loop = value & 0xFFFF;
      return;
    default:
      break;
  }
  switch ((offset & ~std::uintptr_t{0x60}) | 0x20) {
    case 0x520:
      sequence.values = value;
      return;
    case 0x524:
      sequence.count = value & 0x7FFF;
      return;
    case 0x528:
      sequence.refresh = value;
      return;
    case 0x52C:
      sequence.end_delay = value;
      return;
    default:
      no_register(offset);
  }
}

void Nrf52833::write(Pwm& pwm, std::uintptr_t offset, std::uint32_t value) {
  if (offset >= 0x560 && offset <= 0x56C) {
    pwm.pins[(offset - 0x560) / 4] = value;
    return;
  }
  switch (offset) {
    case 0x008:
      return value == 1 ? play(pwm) : void();
    case 0x118:
      demand(value == 0, "an event can only be cleared");
      pwm.period_ended = 0;
      return;
    case 0x200:
      pwm.shortcuts = value;
      return;
    case 0x304:
      pwm.interrupts |= value;
      return;
    case 0x308:
      pwm.interrupts &= ~value;
      return;
    case 0x500:
      pwm.enabled = value == 1;
      return;
    default:
      configure(pwm, offset, value);
  }
}

void Nrf52833::play(Pwm& pwm) {
  if (!pwm.enabled) return;
  demand(pwm.mode == 0 && pwm.prescaler == 4, "the model counts microseconds, and up");
  demand(pwm.decoder == 2 || pwm.decoder == 3, "the model knows a value for each channel only");
  for (const Sequence& sequence : pwm.sequences)
    demand(sequence.count == 4 && sequence.refresh == 0 && sequence.end_delay == 0,
           "the model knows sequences of one period only");
  pwm.plays = true;
  pwm.sequence = 0;
  pwm.loops_left = pwm.loop;
  pwm.counter = 0;
  fetch(pwm);
  begin_period(pwm);
}

// In waveform mode the fourth value is the counter's top.
void Nrf52833::begin_period(Pwm& pwm) {
  pwm.at_work = pwm.fetched;
  if (pwm.decoder == 3) pwm.top = pwm.at_work[3] & 0x7FFF;
  demand(pwm.top > 2, "a counter counts to 3 at least");
  if (fetch_ == Fetch::early) fetch(pwm);
}

void Nrf52833::fetch(Pwm& pwm) {
  const auto* const values =
      static_cast<const volatile std::uint16_t*>(memory_at(pwm.sequences[pwm.sequence].values));
  for (unsigned channel = 0; channel < pwm.fetched.size(); ++channel)
    pwm.fetched[channel] = values[channel];
}

// Plays both sequences as often as LOOP says, and starts over if the shortcut is set; otherwise the last values stay.
void Nrf52833::end_period(Pwm& pwm) {
  pwm.period_ended = 1;
  pwm.counter = 0;
  if (pwm.sequence == 0) {
    demand(pwm.loop != 0, "the model knows loops only");
    pwm.sequence = 1;
  } else if (pwm.loops_left > 0 && --pwm.loops_left > 0) {
    pwm.sequence = 0;
  } else if ((pwm.shortcuts & 1U << 2) != 0) {
    pwm.sequence = 0;
    pwm.loops_left = pwm.loop;
  } else {
    return;
  }
  if (fetch_ == Fetch::late) fetch(pwm);
  begin_period(pwm);
}

void Nrf52833::pass_microsecond() {
  for (Pwm& pwm : pwms_)
    if (pwm.enabled && pwm.plays && ++pwm.counter == pwm.top) end_period(pwm);
}

bool Nrf52833::pwm_interrupt() const {
  return std::ranges::any_of(pwms_, [](const Pwm& pwm) {
    return pwm.period_ended != 0 && (pwm.interrupts & kPeriodEnds) != 0;
  });
}

// IN: only pins whose input buffer is connected. An undriven pin has the level of its pull: none, down or up.
std::uint32_t Nrf52833::read_port(unsigned number, std::uintptr_t offset) const {
  if (offset != 0x510) no_register(offset);
  std::uint32_t levels = 0;
  for (const auto& [pin, high] : wired_) {
    if (pin.first != number) continue;
    const std::uint32_t configuration = ports_[number].configuration[pin.second];
    if ((configuration & 0b10) != 0) continue;
    const unsigned pull = configuration >> 2 & 3;
    demand(high || pull == 1 || pull == 3, "a pin is read that floats");
    if (high.value_or(pull == 3)) levels |= 1U << pin.second;
  }
  return levels;
}

void Nrf52833::write_port(Port& port, std::uintptr_t offset, std::uint32_t value) {
  if (offset >= 0x700) {
    port.configuration[(offset - 0x700) / 4] = value;
  } else if (offset == 0x508) {
    port.out |= value;
  } else if (offset == 0x50C) {
    port.out &= ~value;
  } else {
    no_register(offset);
  }
}

// Once it runs it ignores configuration.
void Nrf52833::write_watchdog(std::uintptr_t offset, std::uint32_t value) {
  switch (offset) {
    case 0x000:
      if (value == 1 && !watchdog_.runs) {
        watchdog_.runs = true;
        watchdog_.left = watchdog_.reload;
      }
      return;
    case 0x504:
      if (!watchdog_.runs) watchdog_.reload = std::max(value, 15U);
      return;
    case 0x508:
      if (!watchdog_.runs) watchdog_.asked = value;
      return;
    case 0x50C:
      if (!watchdog_.runs) watchdog_.configuration = value;
      return;
    case 0x600:
      demand(watchdog_.asked == 1, "the model knows one kick only");
      if (value == 0x6E52'4635) watchdog_.left = watchdog_.reload;
      return;
    default:
      no_register(offset);
  }
}

void Nrf52833::write_row_timer(std::uintptr_t offset, std::uint32_t value) {
  switch (offset) {
    case 0x000:
      row_timer_.runs = row_timer_.runs || value == 1;
      return;
    case 0x004:
      row_timer_.runs = row_timer_.runs && value != 1;
      return;
    case 0x140:
      demand(value == 0, "an event can only be cleared");
      row_timer_.reached = 0;
      return;
    case 0x200:
      row_timer_.shortcuts = value;
      return;
    case 0x304:
      row_timer_.interrupts |= value;
      return;
    case 0x510:
      demand(!row_timer_.runs, "the prescaler is written while the timer runs");
      row_timer_.prescaler = value;
      return;
    case 0x540:
      demand(value < 0x10000, "the timer has 16 bits");
      row_timer_.value = value;
      return;
    default:
      no_register(offset);
  }
}

void Nrf52833::pass_slow_counts(std::uint32_t counts) {
  for (; watchdog_.runs && counts > 0; --counts) {
    if (watchdog_.left == 0)
      watchdog_.expired = true;
    else
      --watchdog_.left;
  }
}

std::uint32_t Nrf52833::read(std::uintptr_t address) {
  if (address == kResetReason) return reset_reason_;
  if (address == kRowTimer + 0x140) return row_timer_.reached;
  if (is_port(address)) {
    const auto [port, offset] = of_port(address);
    return read_port(port, offset);
  }
  for (std::size_t i = 0; i < kPwms.size(); ++i)
    if (address >= kPwms[i] && address < kPwms[i] + 0x1000)
      return read(pwms_[i], address - kPwms[i]);
  no_register(address);
}

void Nrf52833::write(std::uintptr_t address, std::uint32_t value) {
  if (address == kResetReason) {
    reset_reason_ &= ~value;
    return;
  }
  if (address >= kWatchdog && address < kWatchdog + 0x1000)
    return write_watchdog(address - kWatchdog, value);
  if (address >= kRowTimer && address < kRowTimer + 0x1000)
    return write_row_timer(address - kRowTimer, value);
  if (is_port(address)) {
    const auto [port, offset] = of_port(address);
    return write_port(ports_[port], offset, value);
  }
  for (std::size_t i = 0; i < kPwms.size(); ++i)
    if (address >= kPwms[i] && address < kPwms[i] + 0x1000)
      return write(pwms_[i], address - kPwms[i], value);
  no_register(address);
}

// A module requires its pins to be outputs that the port drives low.
Nrf52833::Level Nrf52833::level(Pin pin) const {
  const auto [number, bit] = pin;
  const Port& port = ports_[number];
  const bool output = (port.configuration[bit] & 1) != 0, out = (port.out >> bit & 1) != 0;
  std::optional<bool> pulse;
  for (const Pwm& pwm : pwms_) {
    const auto channel = pwm.channel_at(number << 5 | bit);
    if (!channel) continue;
    demand(!pulse, "two modules have a pin");
    demand(output && !out, "a module has a pin that is not prepared for it");
    pulse = pwm.high(*channel);
  }
  if (!output) return Level::floating;
  return pulse.value_or(out) ? Level::high : Level::low;
}

}  // namespace robosync::tests
