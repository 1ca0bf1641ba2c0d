// A model of a VL53L0X, written from public drivers, since its data sheet (DocID029104) and ST's API (UM2039) were not at hand,
// and independent of our driver: boot after a loss of power or XSHUT, reference registers, single ranging, and the result's
// interrupt.
//
// Where the behaviour is not documented, the model assumes the worst: a new result shows only if SYSTEM_INTERRUPT_CONFIG_GPIO
// requested it, a start during a measurement restarts it, and the last result stays there in the meantime.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>

namespace robosync::test {

class Vl53l0x {
public:
  static constexpr unsigned kValid = 11;
  static constexpr std::uint64_t kBootMs = 2, kMeasuringMs = 33;

  Vl53l0x() { lose_power(); }

  // Its power returns immediately, and it boots.
  void lose_power() {
    registers_.fill(0);
    registers_[0xC0] = 0xEE;
    registers_[0xC1] = 0xAA;
    registers_[0xC2] = 0x10;
    ready_at_.reset();
    boots_until_ = now_ms() + kBootMs;
  }

  // START, the bytes, STOP. False: it did not acknowledge.
  bool transfer(std::span<const std::byte> out, std::span<std::byte> in) {
    if (absent || now_ms() < boots_until_) return false;
    finish();
    auto place = std::to_integer<std::size_t>(out[0]);
    for (const std::byte byte : out.subspan(1))
      write(place++, std::to_integer<std::uint8_t>(byte));
    for (std::byte& byte : in)
      byte = std::byte{registers_.at(place++)};
    return true;
  }

  // The state that an earlier program may leave: with a result that was not read.
  void measure_before(unsigned before_mm) {
    boots_until_ = 0;
    registers_[kConfig] = 4;
    ready_at_ = 0;
    const unsigned now_mm = std::exchange(mm, before_mm);
    finish();
    mm = now_mm;
  }

  void be_named(std::uint8_t model) { registers_[0xC0] = model; }
  bool measures() const { return ready_at_.has_value(); }
  bool has_untaken() const { return (registers_[kInterrupt] & 7) != 0; }

  unsigned mm = 1000, status = kValid;  // of the next result
  bool absent = false;
  unsigned starts = 0;
  std::uint64_t clock_ms = 100;
  std::function<std::uint64_t()> now_ms = [this] { return clock_ms; };

private:
  static constexpr std::size_t kStart = 0x00, kConfig = 0x0A, kClear = 0x0B, kInterrupt = 0x13,
                               kStatus = 0x14, kRange = 0x1E;

  void write(std::size_t place, std::uint8_t value) {
    if (place == kClear) {
      if ((value & 1) != 0) registers_[kInterrupt] = 0;
    } else if (place == kStart) {
      if (value != 1) return;  // other modes are not modelled
      ++starts;
      ready_at_ = now_ms() + kMeasuringMs;
    } else if (place < 0xC0 && place != kInterrupt) {
      registers_.at(place) = value;
    }
  }
  void finish() {
    if (!ready_at_ || now_ms() < *ready_at_) return;
    ready_at_.reset();
    registers_[kStatus] = static_cast<std::uint8_t>(status << 3 | 1);
    registers_[kRange] = static_cast<std::uint8_t>(mm >> 8);
    registers_[kRange + 1] = static_cast<std::uint8_t>(mm & 0xFF);
    constexpr std::uint8_t kNewSample = 4;
    if ((registers_[kConfig] & 7) == kNewSample) registers_[kInterrupt] = kNewSample;
  }

  std::array<std::uint8_t, 256> registers_{};
  std::optional<std::uint64_t> ready_at_;
  std::uint64_t boots_until_ = 0;
};

}  // namespace robosync::test
