#include "runtime-m4/boards/mps2-an386/i2c.hpp"

#include "runtime-m4/boards/mps2-an386/registers.hpp"

namespace robosync::boards::mps2 {

namespace {

// Turns of the waiting loop: four cycles each, 5 µs at 25 MHz.
constexpr unsigned kHalfBit = kClockHz / 200'000 / 4;
// As long as devices may hold the clock down in one transfer, in half bits: 1 ms.
constexpr unsigned kStretchLimit = 200;
constexpr unsigned kMostClocks = 9;  // a byte, and its acknowledgement

void half_bit() {
  for (unsigned i = 0; i < kHalfBit; ++i)
    asm volatile("nop");
}

}  // namespace

void I2c::pull(std::uint32_t line) {
  at<I2cRegisters>(registers_).clear = line;
}

void I2c::release(std::uint32_t line) {
  at<I2cRegisters>(registers_).set = line;
}

bool I2c::is_high(std::uint32_t line) const {
  return (at<I2cRegisters>(registers_).set & line) != 0;
}

// A device may hold the clock down to gain time; not for ever.
bool I2c::release_clock() {
  release(kI2cClock);
  half_bit();
  for (; !is_high(kI2cClock); --patience_) {
    if (patience_ == 0) return false;
    half_bit();
  }
  return true;
}

bool I2c::free_bus() {
  release(kI2cData);
  if (!release_clock()) return false;
  if (is_high(kI2cData)) return true;
  clears_ = static_cast<std::uint16_t>(clears_ + !held_);
  for (unsigned i = 0; i < kMostClocks && !is_high(kI2cData); ++i) {
    pull(kI2cClock);
    half_bit();
    if (!release_clock()) return false;
  }
  return is_high(kI2cData);
}

// Start, or repeated start: the data line falls while the clock is high.
bool I2c::start() {
  release(kI2cData);
  half_bit();
  if (!release_clock() || !is_high(kI2cData)) return false;
  pull(kI2cData);
  half_bit();
  pull(kI2cClock);
  return true;
}

void I2c::stop() {
  pull(kI2cData);
  half_bit();
  if (!release_clock()) return;
  release(kI2cData);
  half_bit();
}

bool I2c::write_bit(bool bit) {
  bit ? release(kI2cData) : pull(kI2cData);
  half_bit();
  if (!release_clock()) return false;
  pull(kI2cClock);
  return true;
}

bool I2c::read_bit(bool& bit) {
  release(kI2cData);
  half_bit();
  if (!release_clock()) return false;
  bit = is_high(kI2cData);
  pull(kI2cClock);
  return true;
}

// False when the device does not acknowledge.
bool I2c::write_byte(std::byte byte) {
  for (unsigned mask = 0x80; mask != 0; mask >>= 1) {
    if (!write_bit((std::to_integer<unsigned>(byte) & mask) != 0)) return false;
  }
  bool refused = true;
  return read_bit(refused) && !refused;
}

bool I2c::read_byte(std::byte& byte, bool last) {
  unsigned value = 0;
  for (unsigned i = 0; i < 8; ++i) {
    bool bit = false;
    if (!read_bit(bit)) return false;
    value = value << 1 | (bit ? 1U : 0U);
  }
  byte = static_cast<std::byte>(value);
  return write_bit(last);  // not acknowledging ends the reading
}

bool I2c::write_message(std::uint8_t address, std::span<const std::byte> out) {
  if (!start() || !write_byte(static_cast<std::byte>(address << 1))) return false;
  for (const std::byte byte : out) {
    if (!write_byte(byte)) return false;
  }
  return true;
}

bool I2c::read_message(std::uint8_t address, std::span<std::byte> in) {
  if (!start() || !write_byte(static_cast<std::byte>(address << 1 | 1))) return false;
  for (std::size_t i = 0; i < in.size(); ++i) {
    if (!read_byte(in[i], i + 1 == in.size())) return false;
  }
  return true;
}

bool I2c::transfer(std::uint8_t address, std::span<const std::byte> out, std::span<std::byte> in) {
  // Nobody waits again for a line that was held down before: others want the processor.
  patience_ = held_ ? 0 : kStretchLimit;
  held_ = !free_bus();
  if (held_) return false;
  patience_ = kStretchLimit;
  const bool done = (out.empty() && !in.empty() ? true : write_message(address, out)) &&
                    (in.empty() ? true : read_message(address, in));
  stop();
  return done;
}

}  // namespace robosync::boards::mps2
