// See six_axes.hpp.
#include "runtime-m4/drivers/six_axes.hpp"

#include <algorithm>

#include "runtime-m4/drivers/i2c_registers.hpp"

namespace robosync::drivers {
namespace {

// Until it has measured, all it has measured is 0. That it measures 0 six times over, to the last bit of its noise, is nothing to
// wait for.
bool has_measured(AxisRegisters acceleration, AxisRegisters turning) {
  const auto is_set = [](std::byte byte) { return byte != std::byte{0}; };
  return std::ranges::any_of(acceleration, is_set) || std::ranges::any_of(turning, is_set);
}

}  // namespace

// Both are asked for, whatever comes of the first one: where the bus works by itself nothing has come of it yet.
bool fetch(boards::Board& board, const vm::Sensor& sensor, const SixAxes& chip,
           SixAxesSample& sample) {
  const bool has_setting = read_registers(board, sensor, chip.setting[0], sample.setting);
  const bool has_output =
      read_registers(board, sensor, chip.output, std::span(sample.output).first(chip.outputs));
  return has_setting && has_output;
}

SixAxesVerdict judge(const SixAxesSample& sample, const SixAxes& chip, unsigned input,
                     std::int32_t& raw) {
  const AxisRegisters acceleration_bytes(sample.output.data() + chip.acceleration, kAxesBytes);
  const AxisRegisters turning_bytes(sample.output.data() + chip.turning, kAxesBytes);
  const bool measures = has_measured(acceleration_bytes, turning_bytes);
  if (!measures && chip.wake[1] != std::byte{0}) return SixAxesVerdict::sleeps;
  if (!std::ranges::equal(sample.setting, std::span(chip.setting).subspan<1>()))
    return SixAxesVerdict::was_not_told;
  if (!measures) return SixAxesVerdict::not_yet;
  raw = input < SixAxes::kTurning ? acceleration(axes_of(acceleration_bytes, chip.order), input)
                                  : axes_of(turning_bytes, chip.order)[input - SixAxes::kTurning];
  return SixAxesVerdict::measured;
}

}  // namespace robosync::drivers
