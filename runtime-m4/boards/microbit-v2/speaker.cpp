// See speaker.hpp. The module plays one value over and over, and fetches it anew for each period, together with the period's
// length. In silence the pin is disconnected from the module, and low.
#include "runtime-m4/boards/microbit-v2/speaker.hpp"

#include <algorithm>
#include <array>

#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit::speaker {

namespace {

constexpr Pin kPin{0, 0};
constexpr Pwm kModule = kPwm2;
constexpr std::uint32_t kCountHz = 1'000'000;
constexpr std::uint32_t kShortest = 4;  // counts; 250 kHz
constexpr std::size_t kTop = 3;         // index in `values`
constexpr std::uint16_t kSilent = 500;  // counts; a tone begins at the end of this period

alignas(4) std::array<volatile std::uint16_t, Pwm::kChannels> values;

}  // namespace

void start() {
  kPin.set_low().write(kPin.mask());
  kPin.configuration().write(Pin::kStrongOutput);
  for (volatile std::uint16_t& value : values)
    value = Pwm::kNever;
  values[kTop] = kSilent;
  kModule.prescaler().write(Pwm::kMicroseconds);
  kModule.decoder().write(Pwm::kValuesAndTop);
  kModule.loop().write(Pwm::kMostLoops);
  kModule.shortcuts().write(Pwm::kPlayAgain);
  for (unsigned sequence = 0; sequence < Pwm::kSequences; ++sequence) {
    kModule.values(sequence).write(port::bus_address(values.data()));
    kModule.count(sequence).write(Pwm::kChannels);
    kModule.refresh(sequence).write(0);
    kModule.end_delay(sequence).write(0);
  }
  kModule.enable().write(Pwm::kOn);
  kModule.play().write(kDoIt);
}

void sound(std::uint32_t hertz) {
  const port::Alone alone;
  if (hertz == 0) {
    kModule.pin(0).write(kNoPin);
    values[0] = Pwm::kNever;
    values[kTop] = kSilent;
    return;
  }
  const std::uint32_t period = std::clamp<std::uint32_t>(kCountHz / hertz, kShortest, Pwm::kNever);
  values[kTop] = static_cast<std::uint16_t>(period);
  values[0] = static_cast<std::uint16_t>(Pwm::kHighUntil | period / 2);
  kModule.pin(0).write(kPin.number());
}

}  // namespace robosync::boards::microbit::speaker
