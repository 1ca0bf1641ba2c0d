// The board's drivers against the devices QEMU emulates: tmp105 at 0x48 on I2C bus 0.
#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/boards/mps2-an386/board.hpp"
#include "runtime-m4/boards/mps2-an386/registers.hpp"
#include "runtime-m4/port/cortex-m4/register.hpp"
#include "tests/runtime-m4/kernel/firmware/rig.hpp"

namespace {

constexpr std::uint8_t kThermometer = 0x48;
constexpr std::byte kHighLimitRegister{3};

// These tests have a handler of their own for the bus's interrupts, so they do its bits.
bool exchange(std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
              std::span<std::byte> in) {
  constexpr unsigned kMostBits = 1000;
  const robosync::port::Alone alone;
  auto& board = robosync::boards::mps2::board;
  board.ask_buses(true);
  const bool asked = board.i2c_transfer(bus, address, out, in);
  board.ask_buses(false);
  for (unsigned i = 0; i < kMostBits && board.buses_busy(); ++i)
    board.i2c(0).on_interrupt();
  return in.empty() ? asked : board.i2c_transfer(bus, address, out, in);
}

std::uint32_t read_limit() {
  const std::array<std::byte, 1> which = {kHighLimitRegister};
  std::array<std::byte, 2> value{};
  if (!exchange(0, kThermometer, which, value)) return 0xFFFF'FFFF;
  return std::to_integer<std::uint32_t>(value[0]) << 8 | std::to_integer<std::uint32_t>(value[1]);
}

void i2c_registers() {
  CHECK(read_limit() == 0x5000);  // 80 °C, the device's value after reset
  const std::array<std::byte, 3> set = {kHighLimitRegister, std::byte{0x2A}, std::byte{0x80}};
  CHECK(exchange(0, kThermometer, set, {}));
  CHECK(read_limit() == 0x2A80);
}

void i2c_absent() {
  std::array<std::byte, 1> byte{};
  std::array<std::byte, 1> got{};
  CHECK(!exchange(0, 0x33, byte, got));
  CHECK(!exchange(0, 0x33, {}, got));
  CHECK(!exchange(1, kThermometer, byte, got));
  CHECK(read_limit() != 0xFFFF'FFFF);  // the bus still works
}

// A device that was interrupted in the middle of a zero, for example by a reset of the board, holds the data line low until it
// gets clocks.
void i2c_cleared() {
  using namespace robosync::boards::mps2;
  const std::uint16_t before = robosync_board.buses().clears;
  const std::array<std::byte, 1> which = {kHighLimitRegister};
  CHECK(exchange(0, kThermometer, which, {}));
  using robosync::port::Register;
  constexpr Register kRelease{kI2c0 + kI2cLines};
  constexpr Register kPull{kI2c0 + kI2cPull};
  const auto send = [&](unsigned bits, unsigned count) {
    for (unsigned mask = 1U << (count - 1); mask != 0; mask >>= 1) {
      ((bits & mask) != 0 ? kRelease : kPull).write(kI2cData);
      kRelease.write(kI2cClock);
      kPull.write(kI2cClock);
    }
  };
  kPull.write(kI2cData);  // start
  kPull.write(kI2cClock);
  send(kThermometer << 1 | 1, 8);
  send(1, 1);  // its acknowledgement
  kRelease.write(kI2cData);
  kRelease.write(kI2cClock);  // its first bit, a zero; then the clock stops
  CHECK(!kRelease.has(kI2cData));
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
    {"I2C: a device that holds the data line gets its clocks, and is counted", i2c_cleared},
    {"virtual PWM pins", pwm_pins},
};

}  // namespace

std::span<const rig::Scenario> rig::device_scenarios() {
  return kScenarios;
}
