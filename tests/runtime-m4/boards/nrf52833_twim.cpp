// See nrf52833_twim.hpp.
#include "tests/runtime-m4/boards/nrf52833_twim.hpp"

#include <stdexcept>
#include <string>

namespace robosync::tests {
namespace {

constexpr std::uint32_t kOpenDrain = 0b110'0000'1100;  // S0D1, pulled up, an input that is read
constexpr std::uint32_t kAddressRefused = 1U << 1, kByteRefused = 1U << 2;

void expect_that(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

std::uint32_t number_of(Nrf52833::Pin pin) {
  return pin.first << 5 | pin.second;
}

}  // namespace

// A line is low if anything pulls it low, otherwise high.
void TwimBus::wire_lines() {
  const bool driven = (configuration_of(clock_) & 1) != 0;
  const bool low = holds_clock || (driven && !is_set(clock_));
  wire(clock_, !low);
  wire(data_, holds_data == 0);
}

void TwimBus::watch_clock() {
  const bool driven = (configuration_of(clock_) & 1) != 0;
  const bool high = !driven || is_set(clock_);
  if (high && !was_high_) {
    ++clocks;
    if (holds_data > 0) --holds_data;
  }
  was_high_ = high;
}

bool TwimBus::interrupt() const {
  return ((interrupts_ & 1U << 1) != 0 && stopped_ != 0) ||
         ((interrupts_ & 1U << 9) != 0 && error_ != 0);
}

void TwimBus::start(Phase phase) {
  if (!enabled_) return;
  expect_that(clock_pin_ == number_of(clock_) && data_pin_ == number_of(data_), "other pins");
  expect_that(configuration_of(clock_) == kOpenDrain && configuration_of(data_) == kOpenDrain,
              "a line is not prepared for the master");
  expect_that(phase_ == Phase::idle || phase_ == Phase::writing, "it is in the midst of something");
  expect_that(frequency_ == 0x0620'0000, "the model knows one speed");
  expect_that(!holds_clock && holds_data == 0, "a start on a bus that somebody holds");
  expect_that(!confused_, "its state is undefined after a stop that it did not send");
  phase_ = phase;
  done_ = 0;
  left_ = kByte;
  (phase == Phase::writing ? has_written_ : has_read_) = 0;
  if (phase == Phase::writing) written.emplace_back();
}

void TwimBus::refuse(std::uint32_t error) {
  errors_ |= error;
  error_ = 1;
  phase_ = Phase::wrong;
}

void TwimBus::stop() {
  phase_ = Phase::stopping;
  left_ = 3;
}

// The address is the first byte of a message.
void TwimBus::write_byte() {
  if (done_ == 0 && of_ != address) return refuse(kAddressRefused);
  if (done_ > refuses_after) return refuse(kByteRefused);
  if (done_ > 0) {
    const auto* const bytes = static_cast<const volatile std::byte*>(memory_at(write_from_));
    const std::byte byte = bytes[done_ - 1];
    written.back().push_back(byte);
    ++has_written_;
    if (done_ == 1)
      place_ = std::to_integer<unsigned>(byte) & 0x7F;
    else
      registers[place_++] = byte;
  }
  if (done_++ < write_count_) return;
  if ((shortcuts_ & 1U << 7) != 0) return start(Phase::reading);
  if ((shortcuts_ & 1U << 9) != 0) return stop();
  throw std::runtime_error("nobody says how it goes on");
}

void TwimBus::read_byte() {
  if (done_ > 0) {
    auto* const bytes = const_cast<volatile std::byte*>(
        static_cast<const volatile std::byte*>(memory_at(read_to_)));
    bytes[done_ - 1] = registers[place_++];
    ++has_read_;
  }
  if (has_read_ >= stops_after) {
    confused_ = true;
    return stop();
  }
  if (done_++ < read_count_) return;
  expect_that((shortcuts_ & 1U << 12) != 0, "nobody ends the reading");
  stop();
}

void TwimBus::next_byte() {
  switch (phase_) {
    case Phase::writing:
      return write_byte();
    case Phase::reading:
      return read_byte();
    case Phase::stopping:
      phase_ = Phase::idle;
      stopped_ = 1;
      return;
    default:
      return;
  }
}

void TwimBus::pass_microsecond() {
  wire_lines();
  if (!enabled_ || holds_clock || phase_ == Phase::idle || phase_ == Phase::wrong) return;
  if (left_ > 0) --left_;
  if (left_ > 0) return;
  left_ = kByte;
  next_byte();
}

std::uint32_t TwimBus::read(std::uintptr_t at) {
  wire_lines();
  if (at < base_ || at >= base_ + 0x1000) return Nrf52833::read(at);
  switch (at - base_) {
    case 0x104:
      return stopped_;
    case 0x124:
      return error_;
    case 0x53C:
      return has_read_;
    case 0x54C:
      return has_written_;
    default:
      throw std::runtime_error("the model has no register at " + std::to_string(at));
  }
}

void TwimBus::write(std::uintptr_t at, std::uint32_t value) {
  if (at >= base_ && at < base_ + 0x1000) return write_own(at - base_, value);
  Nrf52833::write(at, value);
  watch_clock();
}

void TwimBus::write_own(std::uintptr_t offset, std::uint32_t value) {
  switch (offset) {
    case 0x008:
      return value == 1 ? start(Phase::writing) : void();
    case 0x014:
      if (value == 1 && phase_ != Phase::idle) stop();
      return;
    case 0x104:
      expect_that(value == 0, "an event can only be cleared");
      stopped_ = 0;
      return;
    case 0x124:
      expect_that(value == 0, "an event can only be cleared");
      error_ = 0;
      return;
    case 0x304:
      interrupts_ |= value;
      return;
    case 0x4C4:
      errors_ &= ~value;
      return;
    case 0x500:  // off: aborts any transfer and releases its pins
      enabled_ = value == 6;
      if (!enabled_) {
        phase_ = Phase::idle;
        confused_ = false;
      }
      return;
    default:
      return configure(offset, value);
  }
}

void TwimBus::configure(std::uintptr_t offset, std::uint32_t value) {
  const bool its_pins = offset == 0x508 || offset == 0x50C || offset == 0x524;
  expect_that(its_pins ? !enabled_ : phase_ == Phase::idle, "it is changed while it is at work");
  switch (offset) {
    case 0x200:
      shortcuts_ = value;
      return;
    case 0x508:
      clock_pin_ = value;
      return;
    case 0x50C:
      data_pin_ = value;
      return;
    case 0x524:
      frequency_ = value;
      return;
    case 0x534:
      read_to_ = value;
      return;
    case 0x538:
      read_count_ = value;
      return;
    case 0x544:
      write_from_ = value;
      return;
    case 0x548:
      write_count_ = value;
      return;
    case 0x588:
      of_ = value;
      return;
    default:
      throw std::runtime_error("the model has no register at " + std::to_string(offset));
  }
}

}  // namespace robosync::tests
