// The magnetometer ST LIS3MDL (DocID024204): CTRL_REG1 to CTRL_REG5 from 0x20 on, the outputs from OUT_X_L, 0x28, on. 1711 counts
// are a gauss, which is 100 uT. It measures 80 times a second, up to 16 gauss along each axis, as a magnet near it needs; the
// earth's field is then some hundred counts.
//
// After a loss of power it is switched off, and measures up to 4 gauss. Bit 7 of a register's number says to go on to the next one.
#include "runtime-m4/drivers/axes_chip.hpp"

namespace robosync::drivers::lis3mdl {
namespace {

constexpr std::byte kGoOn{0x80};

constexpr AxesChip kChip = {
    // CTRL_REG1 and CTRL_REG4: with the least noise along all axes, 80 Hz; CTRL_REG2: 16 gauss; CTRL_REG3: one measurement after
    // the other; CTRL_REG5: the two bytes of a count do not change between their reads.
    .told = {std::byte{0x20} | kGoOn, std::byte{0x7C}, std::byte{0x60}, std::byte{0},
             std::byte{0x0C}, std::byte{0x40}},
    .settings = 5,
    .inputs = AxesChip::kTurning,
    .wake = {},  // CTRL_REG3 does
    .output = std::byte{0x28} | kGoOn,
    .read = 5 + kAxesBytes,
    .acceleration = 1 + 5,
    .turning = 1 + 5,  // no gyroscope
    .order = std::endian::little,
};

}  // namespace

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& channel,
          std::int32_t& raw) {
  return read_axes(board, sensor, channel, kChip, raw);
}

}  // namespace robosync::drivers::lis3mdl
