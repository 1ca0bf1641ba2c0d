// See flash.hpp. Nordic's nRF52833 Product Specification, 4.3: a part takes up to 9 % longer than specified; writing a word takes
// 43 us. A page is erased when its parts add up to 87 ms (Nordic's nrfx; 85 ms are those of the nRF52840).
#include "runtime-m4/boards/microbit-v2/flash.hpp"

#include "runtime-m4/boards/microbit-v2/registers.hpp"
#include "runtime-m4/boards/microbit-v2/uart.hpp"

namespace robosync::boards::microbit {

namespace {

constexpr std::uint32_t kPartMs = 2;
constexpr unsigned kParts = 45;
constexpr unsigned kMostLooks = 100'000;  // at least some 10 ms

// Runs from RAM and calls only code in RAM, so that the core keeps running and polls the line.
[[gnu::section(".ram_code"), gnu::noinline]] bool erase_part(std::uint32_t page) {
  flash::kErasePartially.write(page);
  for (unsigned i = 0; i < kMostLooks; ++i) {
    Uart::hold();
    if (flash::kReady.has(flash::kIsReady)) return true;
  }
  return false;
}

}  // namespace

Erasing Flash::erase(std::uint32_t page, unsigned call) {
  bool erased = false;
  {
    const port::Unprotected flash_is_open;
    Uart::let_go();
    flash::kEraseMs.write(kPartMs);
    flash::kConfiguration.write(flash::kMayErase);
    erased = erase_part(page);
    flash::kConfiguration.write(flash::kReadOnly);
  }
  if (!erased) return Erasing::failed;
  return call + 1 < kParts ? Erasing::goes_on : Erasing::done;
}

void Flash::program(std::uint32_t at, std::span<const std::uint32_t, kUnit> words) {
  const port::Unprotected flash_is_open;
  flash::kConfiguration.write(flash::kMayWrite);
  port::Register{at}.write(words[0]);
  for (unsigned i = 0; i < kMostLooks && !flash::kReady.has(flash::kIsReady); ++i) {
  }
  flash::kConfiguration.write(flash::kReadOnly);
}

}  // namespace robosync::boards::microbit
