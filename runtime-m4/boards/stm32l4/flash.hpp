// The second bank of the chip's flash, for boards/common/flash_store.hpp. It is erased and written while the core goes on with what
// stands in the first one.
#pragma once

#include <cstdint>
#include <span>

#include "runtime-m4/boards/common/flash_store.hpp"

namespace robosync::boards::stm32l4 {

struct Flash {
  static constexpr std::uint32_t kPage = 2048;
  static constexpr std::size_t kUnit = 2;  // what stands under one checksum of the flash
  static constexpr bool kStalls = false;

  static Erasing erase(std::uint32_t page, unsigned call);
  static bool is_busy();
  static void program(std::uint32_t at, std::span<const std::uint32_t, kUnit> words);

  // A cut of the power may leave two words whose checksum is wrong, or nearly none, and who reads them gets any bits, and
  // an NMI. True when that was so in the second bank: what is read there has checksums of its own, and says whether
  // it is whole.  [NMI]
  static bool forgive_damage();
};

}  // namespace robosync::boards::stm32l4
