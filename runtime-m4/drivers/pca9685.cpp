// NXP PCA9685, 16 outputs of 12 bits on I2C (product data sheet Rev. 4): register numbers 7.3, MODE1 and RESTART 7.3.1, MODE2 7.3.2,
// LEDn_ON and LEDn_OFF 7.3.3, ALL_LED_OFF 7.3.4, PRE_SCALE 7.3.5, OE 7.4.
//
// It counts to 4096 in a frame, in steps of 4.88 us of its own oscillator, which may be off by some percent. An output is high from
// LEDn_ON, here always 0, to LEDn_OFF. Only LEDn_OFF is written for a new pulse, which takes effect with the STOP of the transfer.
// While OE is high its outputs are low, as MODE2 says here: a servo without pulses is limp.
//
// After a loss of power it is asleep, with all outputs off. So MODE1 is read in each frame.
#include <array>
#include <cstddef>
#include <span>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/drivers/served.hpp"
#include "runtime-m4/drivers/servo_chip.hpp"

namespace robosync::drivers {
namespace {

constexpr std::byte kMode1{0x00};
constexpr std::byte kMode2{0x01};
constexpr std::uint8_t kLed0Off = 0x08;  // LED0_OFF_L, LED0_OFF_H
constexpr std::uint8_t kRegistersEach = 4;
constexpr std::byte kAllOn{0xFA};  // ALL_LED_ON_L, ALL_LED_ON_H, ALL_LED_OFF_L, ALL_LED_OFF_H
constexpr std::byte kAllOffHigh{0xFD};
constexpr std::byte kPrescale{0xFE};

// MODE1: it goes on from one register to the next, answers only at its own address …
constexpr std::byte kRuns{0x20};
// … and its oscillator is stopped, without which PRE_SCALE could not be written.
constexpr std::byte kSleeps{0x30};
// It was put to sleep while it gave pulses; a write to an output ends that.
constexpr std::byte kRestart{0x80};
constexpr std::byte kTotemPole{0x04};  // MODE2: outputs low while OE is high
constexpr std::byte kOff{0x10};        // LEDn_OFF_H, ALL_LED_OFF_H: no pulses

constexpr std::uint32_t kOscillatorMHz = 25;
constexpr std::uint32_t kDivider = 122;  // 25 MHz / (4096 * 50 Hz), rounded
constexpr std::byte k50Hz{kDivider - 1};

constexpr unsigned kTries = 3;

struct Sent {
  std::array<std::byte, 1 + kRegistersEach> bytes;
  std::uint8_t length;
  std::span<const std::byte> all() const { return std::span(bytes).first(length); }
};

constexpr Sent one(std::byte place, std::byte value) {
  return {{place, value}, 2};
}

// In this order, so that there are no pulses of a wrong length in between.
constexpr std::array kSetUp{
    one(kAllOffHigh, kOff), one(kMode1, kSleeps),    Sent{{kAllOn, {}, {}, {}, kOff}, 5},
    one(kPrescale, k50Hz),  one(kMode2, kTotemPole), one(kMode1, kRuns)};

Sent setpoint(const guard::OutputGuard::Setpoint& setpoint) {
  const auto place = static_cast<std::byte>(kLed0Off + kRegistersEach * setpoint.channel);
  if (setpoint.pulse == 0) return {{place, {}, kOff}, 3};
  const std::uint32_t counts = (setpoint.pulse * kOscillatorMHz + kDivider / 2) / kDivider;
  return {{place, static_cast<std::byte>(counts & 0xFF), static_cast<std::byte>(counts >> 8)}, 3};
}

// A disturbed write is repeated immediately: until then the state of the output is unknown.
bool write(const ServedBus& at, const Sent& sent) {
  return exchange(at, sent.all(), {}, kTries);
}

bool read_mode(const ServedBus& at, std::byte& mode) {
  return exchange(at, std::span(&kMode1, 1), std::span(&mode, 1), 1);
}

// The oscillator needs 0.5 ms to start (7.3.1): the outputs are enabled in the next frame at the earliest.
bool set_up(const ServedBus& at, guard::OutputGuard& outputs, unsigned sensor) {
  for (const Sent& step : kSetUp)
    if (!write(at, step)) return false;
  outputs.note_chip_set_up(sensor);
  return true;
}

// Sends the pulses that the chip lacks.
bool send_all(const ServedBus& at, guard::OutputGuard& outputs, unsigned sensor) {
  guard::OutputGuard::Setpoint next{};
  for (unsigned from = 0; outputs.next_setpoint(sensor, from, next); from = next.actuator + 1U) {
    if (!write(at, setpoint(next))) return false;
    outputs.note_setpoint(next);
  }
  return true;
}

}  // namespace

bool serve_pca9685(const ServedBus& at, guard::OutputGuard& outputs, unsigned sensor) {
  std::byte mode{};
  if (!read_mode(at, mode)) return false;
  const bool known = outputs.knows_chip(sensor);
  if (known && (mode & ~kRestart) != kRuns) outputs.lose_chip(sensor);
  if (!known || (mode & ~kRestart) != kRuns) return set_up(at, outputs, sensor);
  if (!send_all(at, outputs, sensor)) {
    outputs.lose_chip(sensor);
    return false;
  }
  outputs.let_chip_on(sensor);
  return true;
}

namespace pca9685 {

// It has no channels (the verifier checks this), so none is ever read.
bool read(boards::Board&, const vm::Sensor&, const vm::Channel&, std::int32_t&) {
  return false;
}

}  // namespace pca9685
}  // namespace robosync::drivers
