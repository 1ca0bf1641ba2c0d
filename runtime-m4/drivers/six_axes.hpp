// A chip with an accelerometer and a gyroscope, counts of 16 bits each, on I2C. Its inputs 0 to 3 are those of axes.hpp, 4 to 6 how fast
// it turns about X, Y and Z: above 0 counter-clockwise, as seen from the axis' tip.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "runtime-m4/drivers/axes.hpp"
#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/drivers/i2c_registers.hpp"

namespace robosync::drivers {

struct SixAxes {
  static constexpr std::size_t kSettings = 3, kMostOutputs = 14;
  static constexpr unsigned kTurning = kAxes + 1;  // the first input of these
  static constexpr unsigned kInputs = kTurning + kAxes;

  struct Sample {
    std::array<std::byte, kSettings> setting{};
    std::array<std::byte, kMostOutputs> output{};
  };
  enum class Verdict : std::uint8_t { measured, sleeps, was_not_told, not_yet };

  // False when not all of it has come.
  bool fetch(boards::Board& board, const vm::Sensor& sensor, Sample& sample) const;
  // `raw` is that input, below kInputs, when it was measured.
  Verdict judge(const Sample& sample, unsigned input, std::int32_t& raw) const;

  std::array<std::byte, 1 + kSettings>
      setting;                         // a register, and what it and the next ones are to hold
  std::array<std::byte, 2> wake;       // a register, and what ends its sleep; 0: the setting does
  std::byte output;                    // the first register of what it measures …
  std::uint8_t outputs;                // … how many there are, kMostOutputs at most …
  std::uint8_t acceleration, turning;  // … and which of them are the first ones of these
  std::endian order;                   // of the two bytes of a count
};

// As a ReadFunction. What it is told to do is read with each sample: out of a loss of power it has forgotten that, and is told
// again, one thing with each sample, which is none then. It has no stack frame of its own, and its parts have theirs one after
// the other: a sensor's thread has few bytes left (tests/e2e/test_stack_depth.py).
[[gnu::always_inline]] inline bool read_six_axes(boards::Board& board, const vm::Sensor& sensor,
                                                 const vm::Channel& channel, const SixAxes& chip,
                                                 std::int32_t& raw) {
  if (channel.input >= SixAxes::kInputs) return false;
  SixAxes::Sample sample;
  if (!chip.fetch(board, sensor, sample)) return false;
  const SixAxes::Verdict verdict = chip.judge(sample, channel.input, raw);
  if (verdict == SixAxes::Verdict::sleeps) write_registers(board, sensor, chip.wake);
  if (verdict == SixAxes::Verdict::was_not_told) write_registers(board, sensor, chip.setting);
  return verdict == SixAxes::Verdict::measured;
}

}  // namespace robosync::drivers
