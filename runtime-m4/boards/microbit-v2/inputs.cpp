// See inputs.hpp. The buttons have their own pull-ups (10 kΩ); the chip's do no harm in addition.
#include "runtime-m4/boards/microbit-v2/inputs.hpp"

#include "runtime-m4/boards/common/inputs.hpp"
#include "runtime-m4/boards/microbit-v2/pins.hpp"

namespace robosync::boards::microbit::inputs {

namespace {

constexpr unsigned kLooks = 10'000;  // a word takes 41 us

}  // namespace

// Only if it can be read back is a reset worth it: so there is at most one. In emulation there is another chip, without this
// setting; reading it would be a fault.
bool free_from_nfc() {
  if (information::kPageBytes.read() != information::kOfNrf52833) return false;
  if (!settings::kNfcPins.has(settings::kAreForNfc)) return false;
  unsigned looks = kLooks;
  flash::kConfiguration.write(flash::kMayWrite);
  settings::kNfcPins.write(~settings::kAreForNfc);
  static_cast<void>(happens(flash::kReady, looks));
  flash::kConfiguration.write(flash::kReadOnly);
  return !settings::kNfcPins.has(settings::kAreForNfc);
}

void start() {
  for (const Input& input : kInputs)
    input.chip.configuration().write(Pin::kInputPulledUp);
}

bool is_high(std::uint16_t pin) {
  const std::size_t i = find_input(kInputs, pin);
  if (i < kInputs.size()) return is_high(kInputs[i]);
  const Pin* const chip = pins::chip_pin(pin);
  return chip != nullptr && chip->levels().has(chip->mask());
}

}  // namespace robosync::boards::microbit::inputs
