// ST HTS221, a hygrometer and thermometer (DocID026333). Its counts only have a meaning relative to two points, which are set for
// each part in the factory: values between and beyond them are on the straight line through both. The driver returns
// thousandths of a percent or of a degree.
//
// After a loss of power it is switched off. So each sample also reads its setting, and its two points, since a driver keeps
// nothing. If it is off it is told again, and that sample gives no reading.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/drivers/i2c_registers.hpp"

namespace robosync::drivers::hts221 {
namespace {

constexpr std::byte kGoOn{0x80};  // go on from one register to the next
constexpr std::byte kWho{0x0F};   // WHO_AM_I
constexpr std::byte kIsHts221{0xBC};
constexpr std::byte kControl{0x20};  // CTRL_REG1
// Switched on; the two bytes of a count do not change between their reads; 12.5 times a second.
constexpr std::byte kMeasures{0x87};
constexpr std::size_t kStatus = 7;  // STATUS_REG, counted from CTRL_REG1
constexpr std::byte kBothNew{0b11};
constexpr std::size_t kOutput = 8;  // HUMIDITY_OUT and TEMP_OUT, two bytes each, low byte first
constexpr std::byte kPoints{0x30};  // H0_rH_x2

struct Sample {
  std::array<std::byte, kOutput + 4> state{};
  std::array<std::byte, 16> points{};
};

// In steps of the part: half a percent, or an eighth of a degree.
struct Line {
  std::int32_t low, high;              // at the two points
  std::int32_t low_count, high_count;  // the counts there
  std::int32_t step;                   // thousandths
  std::int32_t least, most;            // thousandths: the measuring range
};

std::int32_t byte_at(const Sample& sample, std::size_t place) {
  return std::to_integer<std::int32_t>(sample.points[place]);
}

std::int32_t count_of(std::span<const std::byte> bytes) {
  const auto word =
      std::to_integer<std::uint32_t>(bytes[0]) | std::to_integer<std::uint32_t>(bytes[1]) << 8;
  return static_cast<std::int16_t>(word);
}

std::int32_t count_at(const Sample& sample, std::size_t place) {
  return count_of(std::span(sample.points).subspan(place, 2));
}

Line humidity_of(const Sample& sample) {
  return {.low = byte_at(sample, 0),
          .high = byte_at(sample, 1),
          .low_count = count_at(sample, 6),
          .high_count = count_at(sample, 10),
          .step = 500,
          .least = 0,
          .most = 100'000};
}

// The upper two bits of both are in T1/T0 msb.
Line temperature_of(const Sample& sample) {
  const std::int32_t upper = byte_at(sample, 5);
  return {.low = byte_at(sample, 2) | (upper & 0b0011) << 8,
          .high = byte_at(sample, 3) | (upper & 0b1100) << 6,
          .low_count = count_at(sample, 12),
          .high_count = count_at(sample, 14),
          .step = 125,
          .least = -40'000,
          .most = 120'000};
}

// Counts have 16 bits and steps 10, so their product has 27. Far beyond both points there would be so many steps that `step`
// times as many overflows: there the value is at its limit anyway.
bool value_at(const Line& line, std::int32_t count, std::int32_t& raw) {
  constexpr std::int32_t kMostSteps = 4096;
  const std::int32_t counts = line.high_count - line.low_count;
  if (counts == 0) return false;
  const std::int32_t product = (line.high - line.low) * (count - line.low_count);
  const std::int32_t steps = line.low + std::clamp(product / counts, -kMostSteps, kMostSteps);
  const std::int32_t rest = line.step * (product % counts) / counts;
  raw = std::clamp(line.step * steps + rest, line.least, line.most);
  return true;
}

// Not inlined: its frame is gone during fetch(). A sensor's thread has few bytes left (tests/e2e/test_stack_depth.py).
[[gnu::noinline]] void tell(boards::Board& board, const vm::Sensor& sensor) {
  write_registers(board, sensor, std::array{kControl, kMeasures});
}

// Requests everything, whatever the first transfer gives: where the bus works on its own, there is no result yet.
[[gnu::noinline]] bool fetch(boards::Board& board, const vm::Sensor& sensor, Sample& sample) {
  std::array<std::byte, 1> who{};
  const bool has_who = read_registers(board, sensor, kWho, who);
  const bool has_state = read_registers(board, sensor, kControl | kGoOn, sample.state);
  const bool has_points = read_registers(board, sensor, kPoints | kGoOn, sample.points);
  return has_who && has_state && has_points && who[0] == kIsHts221;
}

// Until it has measured, its counts are 0. They may be 0 later, too: then a new result is flagged.
bool has_measured(const Sample& sample) {
  return (sample.state[kStatus] & kBothNew) == kBothNew ||
         std::ranges::any_of(std::span(sample.state).subspan<kOutput>(),
                             [](std::byte byte) { return byte != std::byte{0}; });
}

[[gnu::noinline]] bool judge(const Sample& sample, unsigned input, std::int32_t& raw) {
  const auto output = std::span(sample.state).subspan<kOutput>();
  return has_measured(sample) && value_at(input == 0 ? humidity_of(sample) : temperature_of(sample),
                                          count_of(output.subspan(std::size_t{2} * input, 2)), raw);
}

}  // namespace

// Input 0 is the humidity, 1 the temperature.
bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& channel,
          std::int32_t& raw) {
  constexpr std::uint8_t kInputs = 2;
  if (channel.input >= kInputs) return false;
  Sample sample;
  if (!fetch(board, sensor, sample)) return false;
  if ((sample.state[0] & kMeasures) != kMeasures) {
    tell(board, sensor);
    return false;
  }
  return judge(sample, channel.input, raw);
}

}  // namespace robosync::drivers::hts221
