// ST VL53L0X, which measures distance by the time of flight of light (DocID029104). A count is a millimetre. The data sheet
// describes only one of its registers, 0xC0; the others are those of ST's API for it (UM2039), by their names there.
//
// It measures once when told to, in about 33 ms: each sample takes the last result and starts the next measurement. All the
// settings for that are sent each time, so a part that was without power measures again from the next sample on. Without
// ST's tuning it is not calibrated: it may be off by some centimetres.
#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/drivers/i2c_registers.hpp"

namespace robosync::drivers::vl53l0x {
namespace {

constexpr std::byte kModel{0xC0};  // IDENTIFICATION_MODEL_ID
constexpr std::byte kIsVl53l0x{0xEE};

constexpr std::byte kResult{0x13};            // RESULT_INTERRUPT_STATUS; from there on:
constexpr std::size_t kRangeStatus = 1;       // RESULT_RANGE_STATUS
constexpr std::size_t kRange = 11;            // two bytes, high byte first
constexpr std::byte kNew{0b111};              // any of these: there is an unread result
constexpr unsigned kStatusBit = 3;            // of RESULT_RANGE_STATUS, from here on …
constexpr std::byte kStatus{0b1111};          // … this many bits
constexpr std::byte kValid{11};               // every other status is an error
constexpr std::int32_t kNothingThere = 8190;  // mm, or more

// SYSTEM_INTERRUPT_CONFIG_GPIO: signal a new result; SYSTEM_INTERRUPT_CLEAR, right behind it: the last one was read.
constexpr std::array kTellOfTheNext{std::byte{0x0A}, std::byte{0x04}, std::byte{0x01}};
constexpr std::array kMeasure{std::byte{0x00}, std::byte{0x01}};  // SYSRANGE_START: once

struct Sample {
  std::array<std::byte, 1> model{};
  std::array<std::byte, kRange + 2> result{};
};

// Requests both, whatever the first transfer gives: where the bus works on its own, there is no result yet.
[[gnu::noinline]] bool fetch(boards::Board& board, const vm::Sensor& sensor, Sample& sample) {
  const bool has_model = read_registers(board, sensor, kModel, sample.model);
  const bool has_result = read_registers(board, sensor, kResult, sample.result);
  return has_model && has_result && sample.model[0] == kIsVl53l0x;
}

bool judge(const Sample& sample, std::int32_t& raw) {
  const auto& result = sample.result;
  const bool is_new = (result[0] & kNew) != std::byte{0};
  const bool is_valid = (result[kRangeStatus] >> kStatusBit & kStatus) == kValid;
  const auto range = std::to_integer<std::int32_t>(result[kRange]) << 8 |
                     std::to_integer<std::int32_t>(result[kRange + 1]);
  if (!is_new || !is_valid || range >= kNothingThere) return false;
  raw = range;
  return true;
}

}  // namespace

// If there is no result, it is told to measure all the same: samples are further apart than a measurement takes
// (vm::kMinRangingPeriodMs), so it was not told to, or has lost its power since.
bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& /*channel*/,
          std::int32_t& raw) {
  Sample sample;
  if (!fetch(board, sensor, sample)) return false;
  write_registers(board, sensor, kTellOfTheNext);
  write_registers(board, sensor, kMeasure);
  return judge(sample, raw);
}

}  // namespace robosync::drivers::vl53l0x
