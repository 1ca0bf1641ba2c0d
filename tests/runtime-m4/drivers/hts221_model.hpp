// A model of an HTS221, written from public drivers, since ST's data sheet (DocID026333) was not at hand, and independent of our
// driver: registers and their values at power-up, auto-increment by bit 7 of the register's number, power-down and the rates of
// CTRL_REG1, BDU, the data-available bits of STATUS_REG, and the two points of its calibration, which survive a loss of power.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

namespace robosync::test {

class Hts221 {
public:
  struct
      Points {  // of one quantity: its values in half percents or eighths of a degree, and the counts there
    int low, high;
    std::int16_t low_count, high_count;
  };

  Hts221() { lose_power(); }

  void lose_power() {
    registers_.fill(0);
    registers_[kWho] = 0xBC;
    registers_[0x10] = 0x1B;
    next_at_.reset();
  }

  bool transfer(std::span<const std::byte> out, std::span<std::byte> in) {
    if (absent) return false;
    measure();
    auto place = std::to_integer<std::size_t>(out[0]) & 0x7F;
    const bool goes_on = (out[0] & std::byte{0x80}) != std::byte{0};
    for (const std::byte byte : out.subspan(1)) {
      write(place, std::to_integer<std::uint8_t>(byte));
      place += goes_on ? 1U : 0U;
    }
    for (std::byte& byte : in) {
      byte = std::byte{read(place)};
      place += goes_on ? 1U : 0U;
    }
    return true;
  }

  void be_named(std::uint8_t name) { registers_[kWho] = name; }
  std::uint8_t control() const { return registers_[kControl]; }
  void set_control(std::uint8_t value) { write(kControl, value); }
  bool is_on() const { return (control() & 0x80) != 0 && (control() & 3) != 0; }

  // Of a real part: 20 and 80 %, 10 and 35 °C. In some parts the counts of humidity are descending.
  Points humidity_points{40, 160, -4000, 6000};
  Points temperature_points{80, 280, 300, 700};
  double humidity = 50, temperature = 20;                         // %, °C
  std::optional<std::int16_t> humidity_count, temperature_count;  // in their place
  bool absent = false;
  std::uint64_t clock_ms = 100;
  std::function<std::uint64_t()> now_ms = [this] { return clock_ms; };

private:
  static constexpr std::size_t kWho = 0x0F, kControl = 0x20, kStatus = 0x27, kHumidity = 0x28,
                               kTemperature = 0x2A, kCalibration = 0x30;

  std::uint64_t period_ms() const {
    constexpr std::array<std::uint64_t, 4> kPeriods{0, 1000, 143, 80};
    return kPeriods.at(control() & 3U);
  }
  void write(std::size_t place, std::uint8_t value) {
    if (place < 0x10 || (place >= kStatus && place <= kTemperature + 1) || place >= kCalibration)
      return;  // read-only
    const bool was_on = is_on();
    registers_.at(place) = value;
    if (!is_on()) next_at_.reset();
    if (is_on() && !was_on) next_at_ = now_ms() + period_ms();
  }
  std::uint8_t read(std::size_t place) {
    if (place >= kCalibration) return calibration(place - kCalibration);
    if (place == kHumidity + 1) registers_[kStatus] &= 0xFD;
    if (place == kTemperature + 1) registers_[kStatus] &= 0xFE;
    return registers_.at(place);
  }
  std::uint8_t calibration(std::size_t place) const {
    const Points &h = humidity_points, &t = temperature_points;
    const auto low = [](std::int16_t word) { return static_cast<std::uint8_t>(word & 0xFF); };
    const auto high = [](std::int16_t word) { return static_cast<std::uint8_t>(word >> 8 & 0xFF); };
    const auto byte = [](int value) { return static_cast<std::uint8_t>(value & 0xFF); };
    constexpr std::uint8_t kReserved = 0xA5;  // undocumented
    const std::array<std::uint8_t, 16> bytes{
        byte(h.low),       byte(h.high),
        byte(t.low),       byte(t.high),
        kReserved,         byte(0xF0 | (t.high >> 8 & 3) << 2 | (t.low >> 8 & 3)),
        low(h.low_count),  high(h.low_count),
        kReserved,         kReserved,
        low(h.high_count), high(h.high_count),
        low(t.low_count),  high(t.low_count),
        low(t.high_count), high(t.high_count)};
    return bytes.at(place);
  }
  void measure() {
    if (!next_at_ || now_ms() < *next_at_) return;
    next_at_ = now_ms() + period_ms();
    put(kHumidity, humidity_count.value_or(count_of(humidity * 2, humidity_points)));
    put(kTemperature, temperature_count.value_or(count_of(temperature * 8, temperature_points)));
    registers_[kStatus] = 3;
  }
  static std::int16_t count_of(double steps, const Points& points) {
    const double part = (steps - points.low) / (points.high - points.low);
    return static_cast<std::int16_t>(
        std::lround(points.low_count + part * (points.high_count - points.low_count)));
  }
  void put(std::size_t place, std::int16_t count) {
    registers_.at(place) = static_cast<std::uint8_t>(count & 0xFF);
    registers_.at(place + 1) = static_cast<std::uint8_t>(count >> 8 & 0xFF);
  }

  std::array<std::uint8_t, 0x40> registers_{};
  std::optional<std::uint64_t> next_at_;
};

}  // namespace robosync::test
