// An SPI master, a PL022, at 0.96 MHz, in mode 0. A transfer fits into its FIFOs, so the processor waits only for the last byte,
// 26 us at most; a transfer that does not end is given up after some 50 us.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace robosync::boards::mps2 {

namespace spi {

void start();
// Writes `out`, then reads `in`; together at most vm::kMostSpiBytes. False if it does not end.  [one thread at a time]
[[nodiscard]] bool transfer(std::span<const std::byte> out, std::span<std::byte> in);

}  // namespace spi

// For AskingBoard: the transfer is made when its answer is wanted.
struct WaitingSpi {
  static bool transfer(bool ahead, std::uint16_t select, std::span<const std::byte> out,
                       std::span<std::byte> in);
  static void open(std::uint16_t /*select*/) {}
  static void close() {}
  static bool is_busy() { return false; }
};

}  // namespace robosync::boards::mps2
