// See stm32_timers.hpp.
#include "tests/runtime-m4/boards/stm32_timers.hpp"

#include <stdexcept>
#include <string>
#include <tuple>

namespace robosync::tests {
namespace {

constexpr std::uintptr_t kPortClocks = 0x4002'104C;
constexpr std::uintptr_t kTimerClocks = 0x4002'1058;
constexpr std::uintptr_t kTimers = 0x4000'0000, kBetweenTimers = 0x400;
constexpr std::uintptr_t kPorts = 0x4800'0000, kBetweenPorts = 0x400;
constexpr std::uint32_t kPerMicrosecond = 80;

// The timer and channel (from 1) of each pin's function; DS10969, table 17.
using Wired = std::tuple<char, unsigned, unsigned>;
const std::map<Wired, std::pair<unsigned, unsigned>> kFunctions{
    {{'A', 0, 1}, {2, 1}},  {{'A', 0, 2}, {5, 1}},  {{'A', 1, 1}, {2, 2}}, {{'A', 1, 2}, {5, 2}},
    {{'A', 2, 1}, {2, 3}},  {{'A', 2, 2}, {5, 3}},  {{'A', 3, 1}, {2, 4}}, {{'A', 3, 2}, {5, 4}},
    {{'A', 5, 1}, {2, 1}},  {{'A', 6, 2}, {3, 1}},  {{'A', 7, 2}, {3, 2}}, {{'A', 15, 1}, {2, 1}},
    {{'B', 0, 2}, {3, 3}},  {{'B', 1, 2}, {3, 4}},  {{'B', 3, 1}, {2, 2}}, {{'B', 4, 2}, {3, 1}},
    {{'B', 5, 2}, {3, 2}},  {{'B', 6, 2}, {4, 1}},  {{'B', 7, 2}, {4, 2}}, {{'B', 8, 2}, {4, 3}},
    {{'B', 9, 2}, {4, 4}},  {{'B', 10, 1}, {2, 3}}, {{'C', 7, 2}, {3, 2}}, {{'D', 12, 2}, {4, 1}},
    {{'D', 13, 2}, {4, 2}}, {{'D', 14, 2}, {4, 3}}, {{'D', 15, 2}, {4, 4}}};

[[noreturn]] void unknown(std::uintptr_t address) {
  throw std::runtime_error("the model has no register at " + std::to_string(address));
}

}  // namespace

// An update event: preloaded values take effect, and a period begins.
void Stm32Timers::Timer::update() {
  prescaler = prescaler_written;
  last = last_written;
  count = 0;
  for (Channel& channel : channels)
    channel.counts = channel.written;
}

std::uint32_t Stm32Timers::Timer::read(std::uintptr_t offset) const {
  std::uint32_t enables = 0;
  for (unsigned i = 0; i < channels.size(); ++i)
    enables |= static_cast<std::uint32_t>(channels[i].enabled) << 4 * i;
  switch (offset) {
    case 0x00:
      return control;
    case 0x18:
      return channels[0].mode | channels[1].mode << 8;
    case 0x1C:
      return channels[2].mode | channels[3].mode << 8;
    case 0x20:
      return enables;
    case 0x24:
      return count;
    case 0x28:
      return prescaler_written;
    case 0x2C:
      return last_written;
    default:
      break;
  }
  if (offset >= 0x34 && offset <= 0x40) return channels[(offset - 0x34) / 4].written;
  unknown(offset);
}

void Stm32Timers::Timer::write_modes(unsigned first, std::uint32_t value) {
  if ((value & ~0x7878U) != 0) throw std::runtime_error("a mode that the model does not know");
  channels[first].mode = value & 0xFF;
  channels[first + 1].mode = value >> 8 & 0xFF;
}

void Stm32Timers::Timer::write(std::uintptr_t offset, std::uint32_t value) {
  switch (offset) {
    case 0x00:
      control = value;
      return;
    case 0x14:
      if ((value & 1) != 0) update();
      return;
    case 0x18:
      return write_modes(0, value);
    case 0x1C:
      return write_modes(2, value);
    case 0x20:
      for (unsigned i = 0; i < channels.size(); ++i)
        channels[i].enabled = (value >> 4 * i & 1) != 0;
      return;
    case 0x28:
      prescaler_written = value & 0xFFFF;
      return;
    case 0x2C:
      last_written = value;
      if ((control & 1U << 7) == 0) last = value;
      return;
    default:
      break;
  }
  if (offset < 0x34 || offset > 0x40) unknown(offset);
  Channel& channel = channels[(offset - 0x34) / 4];
  channel.written = value;
  if ((channel.mode & 1U << 3) == 0) channel.counts = value;
}

// In PWM mode 1; frozen, the mode after reset, is low.
bool Stm32Timers::Timer::high(unsigned channel) const {
  const Channel& it = channels[channel];
  if (!it.enabled || (it.mode >> 4 & 7) == 0) return false;
  if ((it.mode >> 4 & 7) != 6) throw std::runtime_error("the model knows PWM mode 1 only");
  return count < it.counts;
}

std::uint32_t* Stm32Timers::of_port(std::uintptr_t address) {
  const auto index = (address - kPorts) / kBetweenPorts;
  const auto port = ports_.find(static_cast<char>('A' + index));
  if (port == ports_.end()) unknown(address);
  switch ((address - kPorts) % kBetweenPorts) {
    case 0x00:
      return &port->second.modes;
    case 0x08:
      return &port->second.speeds;
    case 0x0C:
      return &port->second.pulls;
    case 0x20:
      return port->second.functions.data();
    case 0x24:
      return &port->second.functions[1];
    default:
      unknown(address);
  }
}

// IDR: analog pins read 0. An undriven pin has the level of its pull: up (1) or down (2).
std::uint32_t Stm32Timers::levels(char name) const {
  const Port& port = ports_.at(name);
  std::uint32_t levels = 0;
  for (const auto& [pin, high] : wired_) {
    const auto [of, bit] = pin;
    if (of != name || (port.modes >> 2 * bit & 3) == 3) continue;
    const std::uint32_t pull = port.pulls >> 2 * bit & 3;
    if (!high && pull != 1 && pull != 2) throw std::runtime_error("a pin is read that floats");
    if (high.value_or(pull == 1)) levels |= 1U << bit;
  }
  return levels;
}

std::uint32_t Stm32Timers::read(std::uintptr_t address) {
  if (address == kPortClocks) return port_clocks_;
  if (address == kTimerClocks) return timer_clocks_;
  if (address >= kPorts && (address - kPorts) % kBetweenPorts == 0x10) {
    const auto index = (address - kPorts) / kBetweenPorts;
    return (port_clocks_ >> index & 1) != 0 ? levels(static_cast<char>('A' + index)) : 0;
  }
  if (address >= kPorts) return *of_port(address);
  const auto timer = static_cast<unsigned>((address - kTimers) / kBetweenTimers);
  if (timer >= timers_.size()) unknown(address);
  return has_clock(timer) ? timers_[timer].read((address - kTimers) % kBetweenTimers) : 0;
}

// A peripheral without a clock ignores writes.
// BSRR: set takes precedence over reset.
void Stm32Timers::write_port(std::uintptr_t address, std::uint32_t value) {
  if ((address - kPorts) % kBetweenPorts != 0x18) {
    *of_port(address) = value;
    return;
  }
  const auto name = static_cast<char>('A' + (address - kPorts) / kBetweenPorts);
  std::uint32_t& outputs = ports_.at(name).outputs;
  outputs = (outputs & ~(value >> 16)) | (value & 0xFFFF);
}

void Stm32Timers::write(std::uintptr_t address, std::uint32_t value) {
  if (address == kPortClocks) {
    port_clocks_ = value;
  } else if (address == kTimerClocks) {
    timer_clocks_ = value;
  } else if (address >= kPorts) {
    if ((port_clocks_ >> (address - kPorts) / kBetweenPorts & 1) != 0) write_port(address, value);
  } else {
    const auto timer = static_cast<unsigned>((address - kTimers) / kBetweenTimers);
    if (timer >= timers_.size()) unknown(address);
    if (has_clock(timer)) timers_[timer].write((address - kTimers) % kBetweenTimers, value);
  }
}

Stm32Timers::Level Stm32Timers::level(Pin pin) const {
  const auto [name, bit] = pin;
  const Port& port = ports_.at(name);
  if ((port.modes >> 2 * bit & 3) == 1)
    return (port.outputs >> bit & 1) != 0 ? Level::high : Level::low;
  if ((port.modes >> 2 * bit & 3) != 2) return Level::floating;
  const unsigned function = port.functions[bit / 8] >> 4 * (bit % 8) & 0xF;
  const auto wired = kFunctions.find({name, bit, function});
  if (wired == kFunctions.end()) return Level::floating;
  const auto [timer, channel] = wired->second;
  return timers_[timer - 2].high(channel - 1) ? Level::high : Level::low;
}

void Stm32Timers::pass_microsecond() {
  for (unsigned i = 0; i < timers_.size(); ++i) {
    Timer& timer = timers_[i];
    if (!has_clock(i) || (timer.control & 1) == 0) continue;
    if (timer.prescaler + 1 != kPerMicrosecond) throw std::runtime_error("a count is not 1 us");
    if (timer.count == timer.last) {
      timer.update();
    } else {
      ++timer.count;
    }
  }
}

}  // namespace robosync::tests
