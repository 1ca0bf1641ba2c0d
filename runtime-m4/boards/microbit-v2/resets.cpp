// See resets.hpp.
#include "runtime-m4/boards/microbit-v2/resets.hpp"

#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit {

// After a pin reset, other bits may be set by mistake (Nordic's anomaly 136).
ChipReset take_reset_cause() {
  const std::uint32_t causes = power::kResetReason.read();
  power::kResetReason.write(causes);
  if ((causes & power::kPinReset) != 0) return ChipReset::other;
  if ((causes & power::kWatchdogReset) != 0) return ChipReset::watchdog;
  return (causes & power::kLockup) != 0 ? ChipReset::lockup : ChipReset::other;
}

// It may be running already, since a reset by the core may not stop it. Then it ignores these settings, but not the kick.
void start_watchdog(std::uint32_t ms) {
  watchdog::kConfiguration.write(watchdog::kRunsInSleep);
  watchdog::kReload.write(watchdog::kHz * ms / 1000 - 1);
  watchdog::kKicksAsked.write(watchdog::kFirst);
  watchdog::kStart.write(kDoIt);
  kick_watchdog();
}

void kick_watchdog() {
  watchdog::kKick.write(watchdog::kKicked);
}

}  // namespace robosync::boards::microbit
