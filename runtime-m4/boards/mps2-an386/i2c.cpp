#include "runtime-m4/boards/mps2-an386/i2c.hpp"

#include "runtime-m4/boards/mps2-an386/registers.hpp"

namespace robosync::boards::mps2 {

namespace {

// Iterations of the waiting loop: four cycles each, 5 µs at 25 MHz.
constexpr std::uint16_t kHalfBit = kClockHz / 200'000 / 4;
// 1.25 µs, including the code in between.
constexpr std::uint16_t kFastHalfBit = kHalfBit / 6;
// How long devices may hold the clock low in one transfer, in half bits: 1 ms.
constexpr unsigned kStretchLimit = 200;
constexpr unsigned kMostClocks = 9;  // a byte and its acknowledge bit

}  // namespace

void I2c::half_bit() const {
  unsigned turns = half_bit_;
  do
    asm volatile("nop");
  while (--turns != 0);
}

void I2c::pull(std::uint32_t line) {
  at<I2cRegisters>(registers_).clear = line;
}

void I2c::release(std::uint32_t line) {
  at<I2cRegisters>(registers_).set = line;
}

bool I2c::is_high(std::uint32_t line) const {
  return (at<I2cRegisters>(registers_).set & line) != 0;
}

// A device may hold the clock low to gain time, but not for ever. If a sensor took the bus from the store, its transfer is over
// when the store's thread runs again: the bus then has no user.
bool I2c::release_clock() {
  release(kI2cClock);
  half_bit();
  if (user_.load(std::memory_order_relaxed) == User::nobody) return false;
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

// Releases the data line even if the clock does not rise, so that the next user finds it free.
void I2c::stop() {
  pull(kI2cData);
  half_bit();
  static_cast<void>(release_clock());
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
  return write_bit(last);  // a NACK ends the read
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

// Does not wait again for a line that was already held low: other threads need the processor. Also false if a sensor has
// used the bus in the meantime.
bool I2c::prepare(bool taken) {
  patience_ = held_ ? 0 : kStretchLimit;
  const std::uint16_t clears = clears_;
  const bool held = !free_bus();
  if (user_.load(std::memory_order_relaxed) == User::nobody) return false;
  held_ = held;
  // The store's device may have been about to acknowledge when its transfer was interrupted: not a fault of the bus.
  if (taken && !held) {
    clears_ = clears;
    pull(kI2cClock);
    half_bit();
    stop();
  }
  return !held;
}

bool I2c::exchange(std::uint8_t address, std::span<const std::byte> out, std::span<std::byte> in) {
  patience_ = kStretchLimit;
  const bool done = (out.empty() && !in.empty() ? true : write_message(address, out)) &&
                    (in.empty() ? true : read_message(address, in));
  stop();
  user_.store(User::nobody, std::memory_order_relaxed);
  return done;
}

bool I2c::transfer(std::uint8_t address, std::span<const std::byte> out, std::span<std::byte> in) {
  const bool taken = user_.exchange(User::sensor, std::memory_order_relaxed) == User::store;
  if (taken) taken_ = true;
  half_bit_ = kHalfBit;
  if (prepare(taken)) return exchange(address, out, in);
  user_.store(User::nobody, std::memory_order_relaxed);
  return false;
}

Store::Outcome I2c::transfer_between(std::uint8_t address, std::span<const std::byte> out,
                                     std::span<std::byte> in) {
  taken_ = false;
  half_bit_ = kFastHalfBit;
  user_.store(User::store, std::memory_order_relaxed);
  const bool done = prepare(false) && exchange(address, out, in);
  user_.store(User::nobody, std::memory_order_relaxed);
  if (taken_) return Store::Outcome::taken;
  return done ? Store::Outcome::done : Store::Outcome::busy;
}

}  // namespace robosync::boards::mps2
