// See six_axes.hpp.
#include "runtime-m4/drivers/six_axes.hpp"

#include <algorithm>

namespace robosync::drivers {
namespace {

// Until it has measured, all its outputs are 0. Six measured values that are all 0, to the last bit of noise, are too unlikely
// to care about.
bool has_measured(AxisRegisters acceleration, AxisRegisters turning) {
  const auto is_set = [](std::byte byte) { return byte != std::byte{0}; };
  return std::ranges::any_of(acceleration, is_set) || std::ranges::any_of(turning, is_set);
}

}  // namespace

// Requests both, whatever the first transfer gives: where the bus works on its own, there is no result yet.
bool SixAxes::fetch(boards::Board& board, const vm::Sensor& sensor, Sample& sample) const {
  const bool has_setting = read_registers(board, sensor, setting[0], sample.setting);
  const bool has_output =
      read_registers(board, sensor, output, std::span(sample.output).first(outputs));
  return has_setting && has_output;
}

SixAxes::Verdict SixAxes::judge(const Sample& sample, unsigned input, std::int32_t& raw) const {
  const AxisRegisters along(sample.output.data() + acceleration, kAxesBytes);
  const AxisRegisters about(sample.output.data() + turning, kAxesBytes);
  const bool measures = has_measured(along, about);
  if (!measures && wake[1] != std::byte{0}) return Verdict::sleeps;
  if (!std::ranges::equal(sample.setting, std::span(setting).subspan<1>()))
    return Verdict::was_not_told;
  if (!measures) return Verdict::not_yet;
  raw = input < kTurning ? drivers::acceleration(axes_of(along, order), input)
                         : axes_of(about, order)[input - kTurning];
  return Verdict::measured;
}

}  // namespace robosync::drivers
