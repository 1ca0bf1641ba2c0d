// HC-SR04 and similar parts: 10 us or more on the trigger pin make it send a burst, and its echo pin is high for as long as the
// sound takes there and back. A count is a microsecond of that.
//
// It was asked kEchoMs ago (layers/sampler.cpp). Only an echo from between 2 cm and 4 m is a reading: without an echo the part
// keeps its pin high for 38 ms and more, and noise on a wire is shorter than any echo.
#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers::hc_sr04 {
namespace {

constexpr std::uint32_t kShortest = 100;
constexpr std::uint32_t kLongest = 25'000;

}  // namespace

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel&, std::int32_t& raw) {
  const std::uint32_t microseconds = board.take_echo(sensor.address);
  if (microseconds < kShortest || microseconds > kLongest) return false;
  raw = static_cast<std::int32_t>(microseconds);
  return true;
}

}  // namespace robosync::drivers::hc_sr04
