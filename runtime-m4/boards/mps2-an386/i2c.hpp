// An I2C master on two open-drain lines driven by software, about 100 kHz.
//
// Bounded: a device that holds the clock down, holds the data line down or does not answer makes a
// transfer fail, never hang. A data line found held down is freed with clocks, nine at most (a device that was
// interrupted in the middle of a byte then lets go), before the transfer is tried. While a line stays held down, a
// transfer is over at once.
#pragma once

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
  BusState state() const { return {clears_, static_cast<std::uint8_t>(held_)}; }

private:
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
  bool held_ = false;
  unsigned patience_ = 0;  // half bits that devices may still gain
};

}  // namespace robosync::boards::mps2
