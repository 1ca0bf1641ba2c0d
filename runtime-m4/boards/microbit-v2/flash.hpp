// The chip's flash, for boards/common/flash_store.hpp. It also holds the core's code: during an erase or a write every access to
// it stalls, including the core's.
#pragma once

#include <cstdint>
#include <span>

#include "runtime-m4/boards/common/flash_store.hpp"

namespace robosync::boards::microbit {

struct Flash {
  static constexpr std::uint32_t kPage = 4096;
  static constexpr std::size_t kUnit = 1;
  static constexpr bool kStalls = true;

  // Erasing a page takes 87 ms, in parts of 2 ms. During a part nothing else runs, but bytes from the line are kept
  // (Uart::hold()).
  static Erasing erase(std::uint32_t page, unsigned call);
  static bool is_busy() { return false; }  // between two parts
  static void program(std::uint32_t at, std::span<const std::uint32_t, kUnit> words);
};

}  // namespace robosync::boards::microbit
