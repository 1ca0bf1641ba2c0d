// A model of a PCA9685, written from NXP's product data sheet (Rev. 4), independent of the driver: registers and their values at
// power-up (7.3, tables 4 to 8), auto-increment (7.2), sleep and RESTART (7.3.1), outputs that change with the STOP (7.3.2,
// OCH = 0), the prescaler (7.3.5), OE (7.4).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace robosync::test {

class Pca9685 {
public:
  static constexpr unsigned kOutputs = 16;

  // The chip at `address`; `oe_high` returns the level of OE, `now` the time in microseconds.
  Pca9685(std::uint8_t address, std::function<bool()> oe_high, std::function<std::uint64_t()> now)
      : address_(address), oe_high_(std::move(oe_high)), now_(std::move(now)) {
    lose_power();
  }

  void lose_power() {
    registers_.fill(0);
    registers_[kMode1] = kSleep | kAllCall;
    registers_[kMode2] = 0x04;
    registers_[kPrescale] = 0x1E;
    for (unsigned n = 0; n < kOutputs; ++n)
      registers_[off_high(n)] = kFull;
    latch();
  }

  // START, the bytes, STOP. False: it did not acknowledge one of them.
  bool transfer(std::uint8_t address, std::span<const std::byte> out, std::span<std::byte> in) {
    const bool called = address == kAllAddress && (registers_[kMode1] & kAllCall) != 0;
    if (absent || (address != address_ && !called)) return false;
    bool taken = true;
    for (std::size_t i = 0; i < out.size() && taken; ++i) {
      if (disturbed_bytes != 0 && i + 1 == disturbed_bytes) {
        taken = false;
        break;
      }
      const auto byte = std::to_integer<std::uint8_t>(out[i]);
      if (i == 0) {
        pointer_ = byte;
      } else {
        write(pointer_, byte);
        step();
      }
    }
    for (std::byte& byte : in) {
      byte = static_cast<std::byte>(registers_[pointer_]);
      step();
    }
    latch();
    return taken;
  }

  // The pulse on the output in each frame; 0: none.
  double pulse_us(unsigned n) const {
    if (oe_high_() && (registers_[kMode2] & 0x03) == 0) return 0;
    if (sleeps() || (registers_[kMode1] & kRestart) != 0 || now_() < runs_from_) return 0;
    const Output& output = outputs_[n];
    if ((output.off & kFull << 8) != 0) return 0;
    if ((output.on & kFull << 8) != 0) return frame_us();
    const unsigned counts = (output.off - output.on) & 0xFFF;
    return counts * tick_us();
  }
  double frame_us() const { return 4096 * tick_us(); }
  bool sleeps() const { return (registers_[kMode1] & kSleep) != 0; }
  std::uint8_t at(std::uint8_t place) const { return registers_[place]; }
  bool is_off(unsigned n) const { return (outputs_[n].off & kFull << 8) != 0; }

  bool absent = false;  // it has no power, or is disconnected
  std::size_t disturbed_bytes =
      0;  // the byte of each transfer, from 1 on, that is not acknowledged

private:
  struct Output {
    unsigned on = 0, off = 0;
  };
  static constexpr std::uint8_t kMode1 = 0x00, kMode2 = 0x01, kLed0 = 0x06, kAllLeds = 0xFA,
                                kPrescale = 0xFE, kLastLed = 0x45;
  static constexpr std::uint8_t kAllAddress = 0x70;
  static constexpr unsigned kFull = 0x10;
  static constexpr std::uint8_t kRestart = 0x80, kIncrement = 0x20, kSleep = 0x10, kAllCall = 0x01;

  static std::size_t off_high(unsigned n) { return kLed0 + 4 * n + 3; }
  double tick_us() const { return (registers_[kPrescale] + 1) / 25.0; }

  void write(std::uint8_t place, std::uint8_t value) {
    if (place == kMode1) return write_mode(value);
    if (place == kPrescale) {
      if (sleeps()) registers_[place] = value < 3 ? 3 : value;
      return;
    }
    registers_[place] = value;
    if (place >= kAllLeds && place < kPrescale)
      for (unsigned n = 0; n < kOutputs; ++n)
        registers_[kLed0 + 4 * n + (place - kAllLeds)] = value;
    if (place >= kLed0 && (place <= kLastLed || place >= kAllLeds)) output_written_ = true;
  }
  // The chip sets RESTART when it is put to sleep during pulses; writing 1 clears it.
  void write_mode(std::uint8_t value) {
    std::uint8_t restart = registers_[kMode1] & kRestart;
    const bool falls_asleep = !sleeps() && (value & kSleep) != 0;
    if (falls_asleep)
      for (unsigned n = 0; n < kOutputs; ++n)
        if (!is_off(n)) restart = kRestart;
    if ((value & kRestart) != 0 && now_() >= runs_from_) restart = 0;
    if (sleeps() && (value & kSleep) == 0) runs_from_ = now_() + 500;
    registers_[kMode1] = static_cast<std::uint8_t>((value & ~kRestart) | restart);
  }
  void step() {
    if ((registers_[kMode1] & kIncrement) == 0) return;
    if (pointer_ == kLastLed || pointer_ == kPrescale)
      pointer_ = 0;
    else
      ++pointer_;
  }
  // At the STOP.
  void latch() {
    for (unsigned n = 0; n < kOutputs; ++n) {
      const std::size_t first = kLed0 + 4 * n;
      outputs_[n] = {registers_[first] | unsigned{registers_[first + 1]} << 8,
                     registers_[first + 2] | unsigned{registers_[first + 3]} << 8};
    }
    if (output_written_) registers_[kMode1] &= static_cast<std::uint8_t>(~kRestart);
    output_written_ = false;
  }

  std::uint8_t address_;
  std::function<bool()> oe_high_;
  std::function<std::uint64_t()> now_;
  std::array<std::uint8_t, 256> registers_{};
  std::array<Output, kOutputs> outputs_{};
  std::uint8_t pointer_ = 0;
  std::uint64_t runs_from_ = 0;
  bool output_written_ = false;
};

}  // namespace robosync::test
