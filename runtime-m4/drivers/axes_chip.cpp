// See axes_chip.hpp.
#include "runtime-m4/drivers/axes_chip.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace robosync::drivers {
namespace {

// 0 if all bits are.
std::uint32_t bits_of(AxisRegisters registers) {
  std::uint32_t two_axes = 0;
  std::uint16_t last_axis = 0;
  std::memcpy(&two_axes, registers.data(), sizeof two_axes);
  std::memcpy(&last_axis, registers.data() + sizeof two_axes, sizeof last_axis);
  return two_axes | last_axis;
}

// Until it has measured, all its outputs are 0. Measured values that are all 0, to the last bit of noise, are too unlikely to
// care about.
bool has_measured(AxisRegisters acceleration, AxisRegisters turning) {
  return bits_of(acceleration) != 0 || bits_of(turning) != 0;
}

}  // namespace

bool AxesChip::fetch(boards::Board& board, const vm::Sensor& sensor, Sample& sample) const {
  sample[0] = told[0];
  return board.i2c_read_two(sensor.bus, static_cast<std::uint8_t>(sensor.address),
                            {told[0], output, settings}, std::span(sample).subspan(1, read));
}

// Of the setting, most chips have no more than what compares as a word.
bool AxesChip::is_as_told(const Sample& sample) const {
  std::uint32_t is = 0, must_be = 0;
  std::memcpy(&is, sample.data(), sizeof is);
  std::memcpy(&must_be, told.data(), sizeof must_be);
  return is == must_be &&
         (settings < sizeof is || std::equal(told.begin() + sizeof is, told.begin() + 1 + settings,
                                             sample.begin() + sizeof is));
}

AxesChip::Verdict AxesChip::judge(const Sample& sample, unsigned input, std::int32_t& raw) const {
  const AxisRegisters along(&sample[acceleration], kAxesBytes);
  const AxisRegisters about(&sample[turning], kAxesBytes);
  const bool measures = has_measured(along, about);
  if (!measures && wake[1] != std::byte{0}) return Verdict::sleeps;
  if (!is_as_told(sample)) return Verdict::was_not_told;
  if (!measures) return Verdict::not_yet;
  raw = input < kTurning ? drivers::acceleration(along, order, 0, input)
                         : axis_of(about, input - kTurning, order);
  return Verdict::measured;
}

}  // namespace robosync::drivers
