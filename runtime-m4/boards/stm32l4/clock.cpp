// See clock.hpp. The 4 MHz come from MSI, the oscillator inside the chip. It is accurate to about 1 %, which is enough for the
// serial line and for servos, so no crystal is needed.
#include "runtime-m4/boards/stm32l4/clock.hpp"

#include "runtime-m4/boards/stm32l4/registers.hpp"

namespace robosync::boards::stm32l4 {

namespace {

constexpr unsigned kLooks = 10'000;  // at 4 MHz far longer than the PLL takes

bool becomes(Register status, std::uint32_t bits) {
  for (unsigned i = 0; i < kLooks; ++i)
    if ((status.read() & bits) == bits) return true;
  return false;
}

}  // namespace

// The flash's wait states must be set before the core becomes faster.
bool start_clock() {
  flash::kAccess.write(flash::kFourWaits | flash::kPrefetchAndCaches);
  rcc::kPll.write(rcc::kPllOf80MHz);
  rcc::kControl.set(rcc::kPllOn);
  if (!becomes(rcc::kControl, rcc::kPllReady)) return false;
  rcc::kConfiguration.set(rcc::kSwitchToPll);
  return becomes(rcc::kConfiguration, rcc::kRunsOnPll);
}

}  // namespace robosync::boards::stm32l4
