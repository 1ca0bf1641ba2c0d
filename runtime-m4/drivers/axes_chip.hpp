// A chip on I2C with 16-bit counts: an accelerometer and a gyroscope, or a magnetometer. Inputs 0 to 3 are those of axes.hpp; with
// a gyroscope, 4 to 6 are the rates of turning about X, Y and Z, positive if counter-clockwise as seen from the tip of the axis.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "runtime-m4/drivers/axes.hpp"
#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/drivers/i2c_registers.hpp"

namespace robosync::drivers {

struct AxesChip {
  static constexpr std::size_t kMostSettings = 5, kMostOutputs = 14;
  static constexpr unsigned kTurning = kAxes + 1;  // the first input of turning
  static constexpr unsigned kInputs = kTurning + kAxes;

  // Not initialized, which would cost as much as reading it: nobody looks at it unless fetch() has filled it. The first bytes are as
  // `told` begins, so that they compare as a word.
  using Sample = std::array<std::byte, 1 + kMostSettings + kMostOutputs>;
  enum class Verdict : std::uint8_t { measured, sleeps, was_not_told, not_yet };

  // False if not all of it arrived.
  bool fetch(boards::Board& board, const vm::Sensor& sensor, Sample& sample) const;
  // If measured, `raw` is that input, which must be below `inputs`.
  Verdict judge(const Sample& sample, unsigned input, std::int32_t& raw) const;
  [[nodiscard]] std::span<const std::byte> setting() const {
    return std::span(told).first(std::size_t{1} + settings);
  }

  [[nodiscard]] bool is_as_told(const Sample& sample) const;

  // A register, and what it and the next ones must contain, of which there are `settings`.
  std::array<std::byte, 1 + kMostSettings> told;
  std::uint8_t settings;
  std::uint8_t inputs;            // kInputs, or without a gyroscope kTurning
  std::array<std::byte, 2> wake;  // a register, and what ends its sleep; 0: the setting does
  std::byte output;               // the first output register
  std::uint8_t read;              // bytes of settings and outputs, of these at most kMostOutputs
  std::uint8_t acceleration, turning;  // the index in a Sample of the first of each kind
  std::endian order;                   // byte order of a count
};

// As a ReadFunction. Each sample also reads the setting: after a loss of power the chip has lost it, and is told again, one
// thing with each sample, which then gives no reading. It has no stack frame of its own, and its parts use theirs one after
// the other: a sensor's thread has few bytes left (tests/e2e/test_stack_depth.py).
[[gnu::always_inline]] inline bool read_axes(boards::Board& board, const vm::Sensor& sensor,
                                             const vm::Channel& channel, const AxesChip& chip,
                                             std::int32_t& raw) {
  if (channel.input >= chip.inputs) return false;
  AxesChip::Sample sample;
  if (!chip.fetch(board, sensor, sample)) return false;
  const AxesChip::Verdict verdict = chip.judge(sample, channel.input, raw);
  if (verdict == AxesChip::Verdict::sleeps) write_registers(board, sensor, chip.wake);
  if (verdict == AxesChip::Verdict::was_not_told) write_registers(board, sensor, chip.setting());
  return verdict == AxesChip::Verdict::measured;
}

}  // namespace robosync::drivers
