// See six_axes.hpp.
#include "runtime-m4/drivers/six_axes.hpp"

#include <algorithm>

#include "runtime-m4/drivers/i2c_registers.hpp"

namespace robosync::drivers {
namespace {

constexpr unsigned kTurning = kAxes + 1;  // the first input of these
constexpr unsigned kInputs = kTurning + kAxes;

// Until it has measured, all it has measured is 0. That it measures 0 six times over, to the last bit of its noise, is nothing to
// wait for.
bool has_measured(AxisRegisters acceleration, AxisRegisters turning) {
  const auto is_set = [](std::byte byte) { return byte != std::byte{0}; };
  return std::ranges::any_of(acceleration, is_set) || std::ranges::any_of(turning, is_set);
}

}  // namespace

bool read_six_axes(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& channel,
                   const SixAxes& chip, std::int32_t& raw) {
  if (channel.input >= kInputs) return false;
  std::array<std::byte, SixAxes::kSettings> setting{};
  std::array<std::byte, SixAxes::kMostOutputs> output{};
  // Both are asked for, whatever comes of the first one: where the bus works by itself nothing has come of it yet.
  const bool has_setting = read_registers(board, sensor, chip.setting[0], setting);
  const bool has_output =
      read_registers(board, sensor, chip.output, std::span(output).first(chip.outputs));
  if (!has_setting || !has_output) return false;

  const AxisRegisters acceleration_bytes(output.data() + chip.acceleration, kAxesBytes);
  const AxisRegisters turning_bytes(output.data() + chip.turning, kAxesBytes);
  const bool measures = has_measured(acceleration_bytes, turning_bytes);
  if (!measures && chip.wake[1] != std::byte{0}) {
    write_registers(board, sensor, chip.wake);
  } else if (!std::ranges::equal(setting, std::span(chip.setting).subspan<1>())) {
    write_registers(board, sensor, chip.setting);
  } else if (measures) {
    raw = channel.input < kTurning
              ? acceleration(axes_of(acceleration_bytes, chip.order), channel.input)
              : axes_of(turning_bytes, chip.order)[channel.input - kTurning];
    return true;
  }
  return false;
}

}  // namespace robosync::drivers
