// The board's drivers against the devices QEMU emulates: tmp105 at 0x48 on I2C bus 0.
#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/boards/mps2-an386/i2c.hpp"
#include "runtime-m4/boards/mps2-an386/registers.hpp"
#include "tests/runtime-m4/kernel/firmware/rig.hpp"

namespace {

constexpr std::uint8_t kThermometer = 0x48;
constexpr std::byte kHighLimitRegister{3};

std::uint32_t read_limit() {
  const std::array<std::byte, 1> which = {kHighLimitRegister};
  std::array<std::byte, 2> value{};
  if (!robosync_board.i2c_transfer(0, kThermometer, which, value)) return 0xFFFF'FFFF;
  return std::to_integer<std::uint32_t>(value[0]) << 8 | std::to_integer<std::uint32_t>(value[1]);
}

void i2c_registers() {
  CHECK(read_limit() == 0x5000);  // 80 °C, the device's value after reset
  const std::array<std::byte, 3> set = {kHighLimitRegister, std::byte{0x2A}, std::byte{0x80}};
  CHECK(robosync_board.i2c_transfer(0, kThermometer, set, {}));
  CHECK(read_limit() == 0x2A80);
}

void i2c_absent() {
  std::array<std::byte, 1> byte{};
  CHECK(!robosync_board.i2c_transfer(0, 0x33, byte, {}));
  CHECK(!robosync_board.i2c_transfer(0, 0x33, {}, byte));
  CHECK(!robosync_board.i2c_transfer(1, kThermometer, byte, {}));
  CHECK(read_limit() != 0xFFFF'FFFF);  // the bus still works
}

// Nothing is there: reads return 0, as if both lines were held low for ever.
void i2c_held() {
  constexpr std::uintptr_t kNobody = 0x4003'0000;
  robosync::boards::mps2::I2c bus(kNobody);
  std::array<std::byte, 1> byte{};
  CHECK(bus.state().held == 0);
  const auto take = [&] {
    const std::uint32_t began = robosync_kernel.clock();
    CHECK(!bus.transfer(kThermometer, {}, byte));
    CHECK(bus.state().held == 1);
    return robosync_kernel.clock() - began;
  };
  constexpr std::uint32_t kMillisecond = 25'000;
  CHECK(take() < 4 * kMillisecond);
  CHECK(take() < kMillisecond / 20);  // it does not wait for the same line again
  CHECK(read_limit() != 0xFFFF'FFFF);
}

// A device that was interrupted in the middle of a zero, for example by a reset of the board, holds the data line low until it
// gets clocks.
void i2c_cleared() {
  using namespace robosync::boards::mps2;
  const std::uint16_t before = robosync_board.buses().clears;
  const std::array<std::byte, 1> which = {kHighLimitRegister};
  CHECK(robosync_board.i2c_transfer(0, kThermometer, which, {}));
  auto& lines = at<I2cRegisters>(kI2c0);
  const auto send = [&](unsigned bits, unsigned count) {
    for (unsigned mask = 1U << (count - 1); mask != 0; mask >>= 1) {
      (bits & mask) != 0 ? lines.set = kI2cData : lines.clear = kI2cData;
      lines.set = kI2cClock;
      lines.clear = kI2cClock;
    }
  };
  lines.clear = kI2cData;  // start
  lines.clear = kI2cClock;
  send(kThermometer << 1 | 1, 8);
  send(1, 1);  // its acknowledgement
  lines.set = kI2cData;
  lines.set = kI2cClock;  // its first bit, a zero; then the clock stops
  CHECK((lines.set & kI2cData) == 0);
  CHECK(read_limit() != 0xFFFF'FFFF);
  CHECK(robosync_board.buses().clears == before + 1);
  CHECK(robosync_board.buses().held == 0);
  CHECK(read_limit() != 0xFFFF'FFFF);
  CHECK(robosync_board.buses().clears == before + 1);
}

void pwm_pins() {
  robosync_board.pwm_write(5, 1234);
  CHECK(robosync_board.pwm_read(5) == 1234);
  robosync_board.pwm_write(60000, 1);  // no such pin
  CHECK(robosync_board.pwm_read(60000) == 0);
  robosync::boards::switch_outputs_off();
  CHECK(robosync_board.pwm_read(5) == 0);
}

constexpr rig::Scenario kScenarios[] = {
    {"I2C: registers of a device are read and written", i2c_registers},
    {"I2C: a device that is not there does not answer", i2c_absent},
    {"I2C: a line that is held down fails, once slowly", i2c_held},
    {"I2C: a device that holds the data line gets its clocks, and is counted", i2c_cleared},
    {"virtual PWM pins", pwm_pins},
};

}  // namespace

std::span<const rig::Scenario> rig::device_scenarios() {
  return kScenarios;
}
