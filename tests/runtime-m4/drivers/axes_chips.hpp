// Models of chips with an accelerometer and a gyroscope, and of one with a magnetometer: their registers, with auto-increment, and
// their measurements, which are valid only some time after the chip was switched on.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace robosync::test {

inline constexpr unsigned kMostAxes = 6;  // acceleration along X, Y and Z; rotation about them
constexpr bool turns(unsigned axis) {
  return axis >= 3;
}

class ModelOfAxes {
public:
  virtual ~ModelOfAxes() = default;

  bool transfer(std::span<const std::byte> out, std::span<std::byte> in) {
    if (!answers) return false;
    measure();
    auto place = std::to_integer<std::size_t>(out[0] & ~goes_on());
    const std::size_t step = (out[0] & goes_on()) == goes_on() ? 1 : 0;
    for (const std::byte byte : out.subspan(1)) {
      write(place, byte);
      place += step;
    }
    for (std::byte& byte : in) {
      byte = registers.at(place);
      place += step;
    }
    return true;
  }
  virtual void lose_power() = 0;
  virtual bool is_as_told() const = 0;
  virtual std::vector<std::size_t> settings() const = 0;  // their registers
  virtual double counts_each(unsigned axis) const = 0;    // per g, uT or deg/s, in the range set

  std::array<std::byte, 0x80> registers{};
  std::array<double, kMostAxes> motion{0, 0, 1, 0, 0, 0};           // g or uT, deg/s
  std::optional<std::array<std::int32_t, kMostAxes>> exact_counts;  // instead of `motion`
  bool answers = true;
  std::uint64_t clock_ms = 0;
  std::function<std::uint64_t()> now_ms = [this] { return clock_ms; };

protected:
  virtual bool is_on(unsigned axis) const = 0;
  virtual std::size_t low_byte(unsigned axis) const = 0;
  virtual std::size_t high_byte(unsigned axis) const = 0;
  virtual std::uint64_t first_after_ms() const = 0;
  // The bits of a register's number that say to go on to the next one; none: it always does.
  virtual std::byte goes_on() const { return std::byte{0}; }

  void begin() {
    registers.fill(std::byte{0});
    on_since_.fill(std::nullopt);
  }
  void write(std::size_t place, std::byte byte) {
    registers.at(place) = byte;
    for (unsigned axis = 0; axis < kMostAxes; ++axis) {
      if (!is_on(axis)) on_since_.at(axis).reset();
      if (is_on(axis) && !on_since_.at(axis)) on_since_.at(axis) = now_ms();
    }
  }

private:
  void measure() {
    for (unsigned axis = 0; axis < kMostAxes; ++axis)
      if (on_since_.at(axis) && now_ms() >= *on_since_.at(axis) + first_after_ms()) put(axis);
  }
  void put(unsigned axis) {
    const double measured = std::round(motion.at(axis) * counts_each(axis));
    const auto count = static_cast<std::int32_t>(std::clamp(measured, -32768.0, 32767.0));
    const auto bits = static_cast<std::uint16_t>(exact_counts ? exact_counts->at(axis) : count);
    registers.at(low_byte(axis)) = static_cast<std::byte>(bits & 0xFF);
    registers.at(high_byte(axis)) = static_cast<std::byte>(bits >> 8);
  }
  std::array<std::optional<std::uint64_t>, kMostAxes> on_since_{};
};

// ST DocID028475: the registers 0x0F to 0x12, and from 0x22 on; the value of a count in each range.
class Lsm6dsl final : public ModelOfAxes {
public:
  Lsm6dsl() { lose_power(); }
  void lose_power() override {
    begin();
    registers[0x0F] = std::byte{0x6A};
    registers[0x12] = std::byte{0x04};
  }
  bool is_as_told() const override {
    return registers[0x10] == std::byte{0x58} && registers[0x11] == std::byte{0x54} &&
           registers[0x12] == std::byte{0x44};
  }
  std::vector<std::size_t> settings() const override { return {0x10, 0x11, 0x12}; }
  double counts_each(unsigned axis) const override {
    const unsigned range = std::to_integer<unsigned>(control(axis)) >> 2 & 3;
    const std::array each_g{0.061, 0.488, 0.122, 0.244};  // 2, 16, 4, 8 g; thousandths
    const std::array each_turn{8.75, 17.5, 35.0, 70.0};   // 250, 500, 1000, 2000 deg/s
    return 1000 / (turns(axis) ? each_turn : each_g).at(range);
  }

private:
  std::byte control(unsigned axis) const { return registers[turns(axis) ? 0x11 : 0x10]; }
  bool is_on(unsigned axis) const override {
    return (control(axis) & std::byte{0xF0}) != std::byte{0};
  }
  std::size_t low_byte(unsigned axis) const override {
    return turns(axis) ? 0x22 + 2 * (std::size_t{axis} - 3) : 0x28 + 2 * std::size_t{axis};
  }
  std::size_t high_byte(unsigned axis) const override { return low_byte(axis) + 1; }
  std::uint64_t first_after_ms() const override { return 5; }
};

// InvenSense RM-MPU-6000A-00: the registers 26 to 28, 59 to 72 and 107.
class Mpu6050 : public ModelOfAxes {
public:
  Mpu6050() { reset(std::byte{0x40}); }
  void lose_power() override { reset(std::byte{0x40}); }
  bool is_as_told() const override {
    return registers[26] == std::byte{2} && registers[27] == std::byte{8} &&
           registers[28] == std::byte{8} && registers[107] == std::byte{1};
  }
  std::vector<std::size_t> settings() const override { return {26, 27, 28}; }
  double counts_each(unsigned axis) const override {
    const std::byte control = registers[turns(axis) ? 27 : 28];
    const unsigned range = std::to_integer<unsigned>(control) >> 3 & 3;
    return (turns(axis) ? 131.0 : 16384.0) / (1U << range);
  }

protected:
  void reset(std::byte power) {
    begin();
    registers[65] = std::byte{0xF5};  // it is warm
    write(107, power);
  }

private:
  bool is_on(unsigned) const override { return (registers[107] & std::byte{0x40}) == std::byte{0}; }
  std::size_t low_byte(unsigned axis) const override { return high_byte(axis) + 1; }
  std::size_t high_byte(unsigned axis) const override {
    return turns(axis) ? 67 + 2 * (std::size_t{axis} - 3) : 59 + 2 * std::size_t{axis};
  }
  std::uint64_t first_after_ms() const override { return 2; }
};

// It is awake at power-up.
class Mpu6500 final : public Mpu6050 {
public:
  Mpu6500() { reset(std::byte{0x01}); }
  void lose_power() override { reset(std::byte{0x01}); }
};

// ST DocID024204 Rev 4: the registers 0x20 to 0x24, which are 0x10, 0, 3, 0, 0 after a reset, and 0x28 to 0x2D; the counts of a
// gauss, 100 uT, in each range. It has no gyroscope.
class Lis3mdl final : public ModelOfAxes {
public:
  Lis3mdl() { lose_power(); }
  void lose_power() override {
    begin();
    registers[0x0F] = std::byte{0x3D};
    registers[0x20] = std::byte{0x10};
    registers[0x22] = std::byte{0x03};
  }
  bool is_as_told() const override {
    constexpr std::byte kFinest{0x60}, kRate{0x1C}, kWidest{0x60}, kFinestZ{0x0C}, kWhole{0x40};
    return registers[0x20] == (kFinest | kRate) && registers[0x21] == kWidest &&
           registers[0x22] == std::byte{0} && registers[0x23] == kFinestZ &&
           registers[0x24] == kWhole;
  }
  std::vector<std::size_t> settings() const override { return {0x20, 0x21, 0x22, 0x23, 0x24}; }
  double counts_each(unsigned) const override {
    const std::array each_gauss{6842, 3421, 2281, 1711};  // 4, 8, 12, 16 gauss
    return each_gauss.at(std::to_integer<unsigned>(registers[0x21]) >> 5 & 3) / 100.0;
  }

private:
  bool is_on(unsigned axis) const override {
    return !turns(axis) && (registers[0x22] & std::byte{3}) == std::byte{0};
  }
  std::size_t low_byte(unsigned axis) const override { return 0x28 + 2 * std::size_t{axis}; }
  std::size_t high_byte(unsigned axis) const override { return low_byte(axis) + 1; }
  std::uint64_t first_after_ms() const override { return 13; }
  std::byte goes_on() const override { return std::byte{0x80}; }
};

}  // namespace robosync::test
