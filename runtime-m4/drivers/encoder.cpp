// See encoder.hpp.
#include "runtime-m4/drivers/encoder.hpp"

#include <algorithm>

#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers {
namespace {

constexpr std::int64_t kPartsInMicroseconds = std::int64_t{vm::kSpeedParts} * 1'000'000;

std::int32_t speed_of(std::int64_t edges, std::uint32_t took) {
  const std::int64_t speed = edges * kPartsInMicroseconds / std::max<std::uint32_t>(took, 1);
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(speed, INT32_MIN, INT32_MAX));
}

}  // namespace

// Sampled by the class below.
bool encoder::read(boards::Board& /*board*/, const vm::Sensor& /*sensor*/,
                   const vm::Channel& /*channel*/, std::int32_t& /*raw*/) {
  return false;
}

void Encoders::take(guard::OutputGuard& outputs, const vm::Sensor& sensor, unsigned number,
                    kernel::Time time, Wheel& wheel) {
  const auto now = static_cast<std::uint32_t>(time);
  boards::Turned turned{};
  wheel.known = outputs.take_edges(sensor, number, time, turned);
  if (turned.begun)  // it stands
    wheel = {.last = now - static_cast<std::uint32_t>(kStandsUs), .known = wheel.known};
  const std::uint32_t last = now - turned.ago;
  if (turned.edges != wheel.edges) {
    wheel.speed = speed_of(std::int64_t{turned.edges} - wheel.edges, last - wheel.last);
    wheel.edges = turned.edges;
    wheel.last = last;
    return;
  }
  const std::uint32_t quiet = now - wheel.last;
  const std::int32_t most_now = quiet < kStandsUs ? speed_of(1, quiet) : 0;
  wheel.speed = std::clamp(wheel.speed, -most_now, most_now);
  if (quiet >= kStandsUs) wheel.last = now - static_cast<std::uint32_t>(kStandsUs);
}

// Not inlined: it would enlarge the stack frame of every driver's sample.
[[gnu::noinline]] bool Encoders::sample(guard::OutputGuard& outputs, const vm::Sensor& sensor,
                                        unsigned number, bool is_first, std::uint8_t input,
                                        kernel::Time now, std::int32_t& raw) {
  if (number >= wheels_.size()) return false;
  Wheel& wheel = wheels_[number];
  if (is_first) take(outputs, sensor, number, now, wheel);
  if (!wheel.known || input > 1) return false;
  raw = input == 0 ? wheel.edges : wheel.speed;
  return true;
}

}  // namespace robosync::drivers
