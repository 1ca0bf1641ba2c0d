// The accelerometer and gyroscope of an ST LSM6DSL (DocID028475): CTRL1_XL, CTRL2_G and CTRL3_C from 0x10 on, the outputs from
// OUTX_L_G, 0x22, on. A count of acceleration is 0.122 mg, a count of turning is 17.5 thousandths of deg/s. It measures 208 times a
// second, up to 4 g along and 500 deg/s about each axis.
//
// After a loss of power both are switched off. The gyroscope takes 70 ms (AN5040) to settle.
#include "runtime-m4/drivers/axes_chip.hpp"

namespace robosync::drivers::lsm6dsl {
namespace {

constexpr AxesChip kChip = {
    // CTRL1_XL: 208 Hz, 4 g; CTRL2_G: 208 Hz, 500 deg/s; CTRL3_C: the two bytes of a count do not change between their reads, and the
    // register number increments automatically, as it does by default.
    .told = {std::byte{0x10}, std::byte{0x58}, std::byte{0x54}, std::byte{0x44}},
    .settings = 3,
    .inputs = AxesChip::kInputs,
    .wake = {},  // CTRL1_XL and CTRL2_G do
    .output = std::byte{0x22},
    .read = 3 + 12,
    .acceleration = 1 + 3 + 6,
    .turning = 1 + 3,
    .order = std::endian::little,
};

}  // namespace

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& channel,
          std::int32_t& raw) {
  return read_axes(board, sensor, channel, kChip, raw);
}

}  // namespace robosync::drivers::lsm6dsl
