// The flash of the chip, for boards/common/flash_store.hpp: that of the core's own code. While it is erased or written, who wants to
// read it stands still, the core too.
#pragma once

#include <cstdint>
#include <span>

#include "runtime-m4/boards/common/flash_store.hpp"

namespace robosync::boards::microbit {

struct Flash {
  static constexpr std::uint32_t kPage = 4096;
  static constexpr std::size_t kUnit = 1;
  static constexpr bool kStalls = true;

  // A page takes 85 ms. That is cut into parts of 2 ms: while one is at work nobody is served, but bytes of the line are
  // kept (Uart::hold()).
  static Erasing erase(std::uint32_t page, unsigned call);
  static bool is_busy() { return false; }  // between two parts
  static void program(std::uint32_t at, std::span<const std::uint32_t, kUnit> words);
};

}  // namespace robosync::boards::microbit
