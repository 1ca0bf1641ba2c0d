// The accelerometer and gyroscope of an InvenSense MPU-6050 (RM-MPU-6000A-00 Rev. 4.2): CONFIG, GYRO_CONFIG and ACCEL_CONFIG, registers
// 26 to 28, the outputs, 59 to 72, PWR_MGMT_1, 107; or of an MPU-6500, which has the same registers. 8192 counts are a g, 65.5 a deg/s.
// It measures a thousand times a second, up to 4 g along and 500 deg/s about each axis, and filters out what changes faster than
// about 95 Hz. The temperature is between acceleration and turning.
//
// After a loss of power it sleeps, and its outputs are 0. Its gyroscope takes 30 ms to settle. What is read together was measured
// together, so the two bytes of a count do not change between their reads.
#include "runtime-m4/drivers/axes_chip.hpp"

namespace robosync::drivers::mpu6050 {
namespace {

constexpr AxesChip kChip = {
    // CONFIG: filter 2; GYRO_CONFIG: 500 deg/s; ACCEL_CONFIG: 4 g.
    .told = {std::byte{0x1A}, std::byte{0x02}, std::byte{0x08}, std::byte{0x08}},
    .settings = 3,
    .inputs = AxesChip::kInputs,
    // PWR_MGMT_1: no sleep, and a gyroscope's clock, which is better than the chip's internal one.
    .wake = {std::byte{0x6B}, std::byte{0x01}},
    .output = std::byte{0x3B},
    .read = 3 + 14,
    .acceleration = 1 + 3,
    .turning = 1 + 3 + 8,
    .order = std::endian::big,
};

}  // namespace

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& channel,
          std::int32_t& raw) {
  return read_axes(board, sensor, channel, kChip, raw);
}

}  // namespace robosync::drivers::mpu6050
