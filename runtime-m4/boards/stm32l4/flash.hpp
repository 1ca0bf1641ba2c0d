// The second bank of the chip's flash, for boards/common/flash_store.hpp. The core keeps running from the first bank while the
// second is erased and written.
#pragma once

#include <cstdint>
#include <span>

#include "runtime-m4/boards/common/flash_store.hpp"

namespace robosync::boards::stm32l4 {

struct Flash {
  static constexpr std::uint32_t kPage = 2048;
  static constexpr std::size_t kUnit = 2;  // words under one checksum (ECC) of the flash
  static constexpr bool kStalls = false;

  static Erasing erase(std::uint32_t page, unsigned call);
  static bool is_busy();
  static void program(std::uint32_t at, std::span<const std::uint32_t, kUnit> words);

  // A power cut may leave two words with a wrong or undefined checksum. Reading them returns arbitrary bits and raises an
  // NMI. True if that happened in the second bank: the data there has its own checksums, which detect the
  // damage.  [NMI]
  static bool forgive_damage();
};

}  // namespace robosync::boards::stm32l4
