// An I2C master on two open-drain lines driven by software, about 100 kHz.
//
// It has two kinds of users: sensors, and the board's store, which ranks below them. A sensor takes the bus away from the store
// even in the middle of a transfer, so that it never waits for it.
//
// Time is bounded: a device that holds the clock low, holds the data line low or does not answer makes a
// transfer fail, never hang. If the data line is held low before a transfer, up to nine clocks free it (a device that was
// interrupted in the middle of a byte then releases it). While a line stays low, a transfer fails immediately.
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

  // Writes `out`, then, after a repeated start, reads `in`; an empty one is skipped. False when
  // the device does not acknowledge or the bus is stuck. About 100 µs a byte.
  // [one thread at a time]
  [[nodiscard]] bool transfer(std::uint8_t address, std::span<const std::byte> out,
                              std::span<std::byte> in);
  // The same for the store, about 400 kHz. `taken`: a transfer() preempted it and has made the device abort. No transfer() may
  // come during a read: a sending device may hold the data line.  [the thread with the lowest rank]
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
  std::uint16_t half_bit_ = 1;  // iterations of half_bit() for the current user
  bool held_ = false;
  std::atomic<User> user_ = User::nobody;
  std::atomic<bool> taken_ = false;  // by a sensor, from the store
  unsigned patience_ = 0;            // half bits for which devices may still hold the clock low
};

}  // namespace robosync::boards::mps2
