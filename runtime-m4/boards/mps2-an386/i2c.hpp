// An I2C master on two open-drain lines driven by software, about 100 kHz.
//
// Two kinds of users: sensors, and the board's store, which ranks below them. A sensor takes the bus away from the store
// in the middle of a transfer, so that it never waits for it.
//
// Bounded: a device that holds the clock down, holds the data line down or does not answer makes a
// transfer fail, never hang. A data line found held down is freed with clocks, nine at most (a device that was
// interrupted in the middle of a byte then lets go), before the transfer is tried. While a line stays held down, a
// transfer is over at once.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/board.hpp"

namespace robosync::boards::mps2 {

class I2c {
public:
  explicit constexpr I2c(std::uintptr_t registers) : registers_(registers) {}

  // Writes `out`, then, after a repeated start, reads `in`; an empty one is left out. False when
  // the device does not acknowledge or the bus is stuck. About 100 µs a byte.
  // [one thread at a time]
  [[nodiscard]] bool transfer(std::uint8_t address, std::span<const std::byte> out,
                              std::span<std::byte> in);
  // The same for the store, about 400 kHz. `taken`: a transfer() came between, and has told the device to forget. While it
  // reads none may come: a device that sends lets go of the bus when it likes.  [the thread with the lowest rank]
  [[nodiscard]] Store::Outcome transfer_between(std::uint8_t address,
                                                std::span<const std::byte> out,
                                                std::span<std::byte> in);
  BusState state() const { return {clears_, static_cast<std::uint8_t>(held_)}; }

private:
  enum class User : std::uint8_t { nobody, sensor, store };

  bool prepare(bool taken);
  bool exchange(std::uint8_t address, std::span<const std::byte> out, std::span<std::byte> in);
  void half_bit() const;
  bool write_message(std::uint8_t address, std::span<const std::byte> out);
  bool read_message(std::uint8_t address, std::span<std::byte> in);
  bool free_bus();
  bool start();
  void stop();
  bool write_byte(std::byte byte);
  bool read_byte(std::byte& byte, bool last);
  bool write_bit(bool bit);
  bool read_bit(bool& bit);
  bool release_clock();
  void pull(std::uint32_t line);
  void release(std::uint32_t line);
  bool is_high(std::uint32_t line) const;

  std::uintptr_t registers_;
  std::uint16_t clears_ = 0;
  std::uint16_t half_bit_ = 1;  // turns of its loop, for who uses the bus
  bool held_ = false;
  std::atomic<User> user_ = User::nobody;
  std::atomic<bool> taken_ = false;  // by a sensor, from the store
  unsigned patience_ = 0;            // half bits that devices may still gain
};

}  // namespace robosync::boards::mps2
