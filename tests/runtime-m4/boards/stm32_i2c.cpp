// See stm32_i2c.hpp. RM0351, 39 (I2C), 11 (DMA), 8 (GPIO).
#include "tests/runtime-m4/boards/stm32_i2c.hpp"

#include <utility>

namespace robosync::tests {
namespace {

constexpr std::uintptr_t kPortB = 0x4800'0400, kDma = 0x4002'0000, kDmaSelect = 0x4002'00A8,
                         kAhb1 = 0x4002'1048, kApb1 = 0x4002'1058;
constexpr std::uint32_t kOn = 1, kSendByDma = 1U << 14, kReadByDma = 1U << 15;
constexpr std::uint32_t kNackInterrupt = 1U << 4, kStopInterrupt = 1U << 5, kEndInterrupt = 1U << 6,
                        kErrorInterrupt = 1U << 7;
constexpr std::uint32_t kReading = 1U << 10, kBegins = 1U << 13, kAutoEnd = 1U << 25;
constexpr std::uint32_t kEmpty = 1U << 0, kNack = 1U << 4, kStopped = 1U << 5, kComplete = 1U << 6,
                        kBusError = 1U << 8, kArbitrationLost = 1U << 9, kIsBusy = 1U << 15;
constexpr std::uint32_t kRequestOfI2c = 3, kFunctionOfI2c = 4;

}  // namespace

// An output may only be low as open drain, or the device would drive against it.
bool Stm32I2c::pulls_low(unsigned pin) const {
  if ((pins_.at(0x00) >> 2 * pin & 3) != 1) return false;
  demand((pins_.at(0x04) >> pin & 1) != 0, "a line of a bus is driven high");
  return (pins_.at(0x14) >> pin & 1) == 0;
}

bool Stm32I2c::is_mode_of_master(unsigned pin) const {
  return (pins_.at(0x00) >> 2 * pin & 3) == 2 && (pins_.at(0x04) >> pin & 1) != 0 &&
         (pins_.at(0x0C) >> 2 * pin & 3) == 1 &&
         (pins_.at(pin < 8 ? 0x20 : 0x24) >> 4 * (pin % 8) & 0xF) == kFunctionOfI2c;
}

// A line is low if anything pulls it low, otherwise high. An analog pin has no level.
std::uint32_t Stm32I2c::levels() const {
  std::uint32_t high = 0;
  const bool low[] = {holds_clock || pulls_low(wiring_.clock_pin),
                      holds_data != 0 || pulls_low(wiring_.data_pin)};
  const unsigned pins[] = {wiring_.clock_pin, wiring_.data_pin};
  for (unsigned i = 0; i < 2; ++i)
    if (!low[i] && (pins_.at(0x00) >> 2 * pins[i] & 3) != 3) high |= 1U << pins[i];
  return high;
}

void Stm32I2c::watch_clock() {
  const bool high = !pulls_low(wiring_.clock_pin);
  if (!high) demand(!is_on(), "clocks by hand while the master is on");
  if (high && !was_high_) {
    ++clocks;
    if (holds_data > 0) --holds_data;
  }
  was_high_ = high;
}

bool Stm32I2c::interrupt() const {
  const auto both = [&](std::uint32_t enabled, std::uint32_t flags) {
    return (control_ & enabled) != 0 && (state_ & flags) != 0;
  };
  return both(kNackInterrupt, kNack) || both(kStopInterrupt, kStopped) ||
         both(kEndInterrupt, kComplete) || both(kErrorInterrupt, kBusError | kArbitrationLost);
}

// The address in memory of the next byte by DMA; null if the channel transfers none.
volatile std::byte* Stm32I2c::dma(unsigned number, bool from_memory, std::uint32_t data_register) {
  Channel& channel = channels_[number];
  if ((channel.control & 1) == 0 || channel.count == 0) return nullptr;
  if (std::exchange(dma_fails, false)) {
    channel.failed = true;
    channel.control &= ~1U;
    return nullptr;
  }
  demand((dma_clock_ & 1) != 0, "DMA1 has no clock");
  demand((select_ >> 4 * (number - 1) & 0xF) == kRequestOfI2c, "the channel hears somebody else");
  // Byte transfers; only the memory's address increments; not circular.
  demand((channel.control & 0x7FFE) == (from_memory ? 0x90U : 0x80U), "the channel is set wrong");
  demand(channel.peripheral == wiring_.base + data_register, "the channel is for something else");
  --channel.count;
  auto* const memory = const_cast<volatile std::byte*>(
      static_cast<const volatile std::byte*>(memory_at(channel.memory)));
  return memory + channel.moved++;
}

// Fetches as soon as there is room: one byte waits behind the one that is being sent.
void Stm32I2c::fetch() {
  if (data_waits_ || (control_ & kSendByDma) == 0) return;
  if (const auto* const byte = dma(wiring_.send_channel, true, 0x28)) {
    data_ = *byte;
    data_waits_ = true;
  }
}

void Stm32I2c::start() {
  demand(is_mode_of_master(wiring_.clock_pin) && is_mode_of_master(wiring_.data_pin),
         "a line is not prepared for the master");
  demand(timing_ != 0, "nobody said how fast");
  demand(!holds_clock && holds_data == 0, "a start on a bus that somebody holds");
  transfer_ &= ~kBegins;
  state_ |= kIsBusy;
  phase_ = (transfer_ & kReading) != 0 ? Phase::reading : Phase::sending;
  done_ = 0;
  left_ = kByte;
  if (phase_ == Phase::sending) written.emplace_back();
}

void Stm32I2c::refuse() {
  state_ |= kNack;
  stop();  // automatic
}

void Stm32I2c::stop() {
  phase_ = Phase::stopping;
  left_ = 3;
}

void Stm32I2c::end_of_bytes() {
  if ((transfer_ & kAutoEnd) != 0) return stop();
  state_ |= kComplete;
  phase_ = Phase::ended;  // holds the clock low until the next command
}

// The address is the first byte of a message.
void Stm32I2c::send_byte() {
  if (done_ == 0 && (transfer_ & 0x3FF) != address << 1) return refuse();
  if (done_ > refuses_after) return refuse();
  if (done_ > 0) {
    written.back().push_back(data_);
    data_waits_ = false;
    if (done_ == 1)
      place_ = std::to_integer<unsigned>(data_) & 0x7F;
    else
      registers[place_++] = data_;
  }
  if (done_ == (transfer_ >> 16 & 0xFF)) return end_of_bytes();
  ++done_;
  fetch();
}

void Stm32I2c::read_byte() {
  if (done_ == 0 && (transfer_ & 0x3FF) != address << 1) return refuse();
  if (done_ > 0) {
    demand((control_ & kReadByDma) != 0, "nobody takes what is read");
    volatile std::byte* const byte = dma(wiring_.read_channel, false, 0x24);
    const bool is_last = done_ == (transfer_ >> 16 & 0xFF);
    if (byte == nullptr && !is_last)
      return;  // holds the clock low; the last byte is not waited for
    if (byte != nullptr) *byte = registers[place_++];
  }
  if (done_ == (transfer_ >> 16 & 0xFF)) return end_of_bytes();
  ++done_;
}

void Stm32I2c::next_byte() {
  if (spurious_bus_error) state_ |= kBusError;
  spurious_bus_error = false;
  if (another_master) {  // it has lost the bus, and no stop is reported
    another_master = false;
    state_ |= kArbitrationLost;
    phase_ = Phase::idle;
    return;
  }
  switch (phase_) {
    case Phase::sending:
      if (done_ > 0 && !data_waits_) return fetch();  // the clock is held low
      return send_byte();
    case Phase::reading:
      return read_byte();
    case Phase::stopping:
      phase_ = Phase::idle;
      state_ = (state_ & ~kIsBusy) | kStopped;
      return;
    default:
      return;
  }
}

void Stm32I2c::pass_microsecond() {
  if (!is_on() || holds_clock) return;
  if ((transfer_ & kBegins) != 0 && (phase_ == Phase::idle || phase_ == Phase::ended)) start();
  if (phase_ == Phase::idle || phase_ == Phase::ended) return;
  if (left_ > 0) --left_;
  if (left_ > 0) return;
  left_ = kByte;
  next_byte();
}

// The software reset: the configuration stays, everything else is as after a reset.
void Stm32I2c::reset() {
  phase_ = Phase::idle;
  state_ = kEmpty;
  data_waits_ = false;
  transfer_ &= ~kBegins;
}

std::uint32_t Stm32I2c::pin_register(std::uintptr_t offset) const {
  if (offset == 0x10) return levels();
  if (!pins_.contains(offset)) no_register(kPortB + offset);
  return pins_.at(offset);
}

std::uint32_t Stm32I2c::read(std::uintptr_t at) {
  if (at >= kPortB && at < kPortB + 0x400) return pin_register(at - kPortB);
  if (at == kAhb1) return dma_clock_;
  if (at == kApb1) return clock_;
  if (at == kDmaSelect) return select_;
  if (at >= kDma + 0x08 && at < kDmaSelect) {
    const Channel& channel = channels_[static_cast<unsigned>((at - kDma - 8) / 20 + 1)];
    demand((at - kDma - 8) % 20 == 4, "of a channel the count is of interest");
    return channel.count;
  }
  demand(at >= wiring_.base && at < wiring_.base + 0x400, "another register");
  switch (at - wiring_.base) {
    case 0x00:
      reset_seen_ = true;
      return control_;
    case 0x18:
      return data_waits_ ? state_ & ~kEmpty : state_ | kEmpty;
    default:
      no_register(at);
  }
}

void Stm32I2c::write_pin(std::uintptr_t offset, std::uint32_t value) {
  if (offset == 0x18) {
    pins_[0x14] = (pins_[0x14] & ~(value >> 16)) | (value & 0xFFFF);
  } else {
    if (!pins_.contains(offset)) no_register(kPortB + offset);
    pins_[offset] = value;
  }
  watch_clock();
}

void Stm32I2c::write_channel(std::uintptr_t offset, std::uint32_t value) {
  Channel& channel = channels_[static_cast<unsigned>((offset - 8) / 20 + 1)];
  demand((offset - 8) % 20 == 0 || (channel.control & 1) == 0, "it is changed while it is on");
  switch ((offset - 8) % 20) {
    case 0:
      channel.control = channel.failed ? value & ~1U : value;
      channel.moved = 0;
      return;
    case 4:
      channel.count = value;
      return;
    case 8:
      channel.peripheral = value;
      return;
    default:
      channel.memory = value;
      return;
  }
}

void Stm32I2c::write_control(std::uint32_t value) {
  demand((clock_ & wiring_.clock_enable) != 0, "it has no clock");
  const bool on = (value & kOn) != 0;
  if (on && !is_on()) demand(reset_seen_, "off for three cycles of the bus at least");
  if (!on && is_on()) {
    reset();
    reset_seen_ = false;
  }
  control_ = value;
}

// 39.4.9, with edges of up to 300 ns each, and the filter's 50 ns: I2C's fast mode, from 80 MHz.
void Stm32I2c::write_timing(std::uint32_t value) {
  demand((clock_ & wiring_.clock_enable) != 0 && !is_on(), "said while it is off");
  const double unit = 12.5 * ((value >> 28) + 1);
  const double low = ((value & 0xFF) + 1) * unit, high = ((value >> 8 & 0xFF) + 1) * unit;
  demand(low >= 1300 && high >= 600, "the clock is low for 1.3 us, and high for 0.6");
  demand(low + high + 2 * (50 + 2 * 12.5) >= 2500, "it is too fast");
  demand(low + high <= 3000, "slower than it must be");
  demand(((value >> 20 & 0xF) + 1) * unit >= 300 + 100, "the data comes too late");
  demand((value >> 16 & 0xF) * unit >= 300 - 50 - 3 * 12.5, "the data goes too early");
  demand((value >> 16 & 0xF) * unit <= 900 - 300 - 260 - 4 * 12.5, "the data goes too late");
  timing_ = value;
}

void Stm32I2c::write_transfer(std::uint32_t value) {
  demand((transfer_ & kBegins) == 0, "a start was asked for already");
  demand((value & ~(0x2FF'0000U | kReading | kBegins | 0xFE)) == 0, "the model knows no more");
  demand((value & kBegins) != 0 && is_on(), "a start by a master that is on");
  demand(phase_ == Phase::idle || phase_ == Phase::ended, "it is in the midst of something");
  transfer_ = value;
  state_ &= ~kComplete;
}

void Stm32I2c::write_own(std::uintptr_t offset, std::uint32_t value) {
  switch (offset) {
    case 0x00:
      return write_control(value);
    case 0x04:
      return write_transfer(value);
    case 0x10:
      return write_timing(value);
    case 0x1C:
      demand((value & ~(kNack | kStopped | kBusError | kArbitrationLost)) == 0, "what is that?");
      state_ &= ~value;
      return;
    default:
      no_register(wiring_.base + offset);
  }
}

void Stm32I2c::write(std::uintptr_t at, std::uint32_t value) {
  if (at >= kPortB && at < kPortB + 0x400) return write_pin(at - kPortB, value);
  if (at == kAhb1) {
    dma_clock_ = value;
  } else if (at == kApb1) {
    clock_ = value;
  } else if (at == kDmaSelect) {
    select_ = value;
  } else if (at == kDma + 0x04) {
    for (auto& [number, channel] : channels_)
      if ((value >> 4 * (number - 1) & 0b1001) != 0) channel.failed = false;
  } else if (at >= kDma + 0x08 && at < kDmaSelect) {
    write_channel(at - kDma, value);
  } else {
    demand(at >= wiring_.base && at < wiring_.base + 0x400, "another register");
    write_own(at - wiring_.base, value);
  }
}

}  // namespace robosync::tests
