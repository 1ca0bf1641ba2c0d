// The board's drivers against the devices QEMU emulates: tmp105 at 0x48 on I2C bus 0.
#include "runtime-m4/boards/common/firmware.hpp"
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
    {"virtual PWM pins", pwm_pins},
};

}  // namespace

std::span<const rig::Scenario> rig::device_scenarios() {
  return kScenarios;
}
