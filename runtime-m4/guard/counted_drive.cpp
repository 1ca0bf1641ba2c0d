// The encoders of a drive, and the wheels of a board that has none: see output_guard.hpp.
#include <algorithm>
#include <cstdint>

#include "runtime-m4/guard/output_guard.hpp"

namespace robosync::guard {
namespace {

constexpr std::int64_t kMostRate = 100'000;  // edges a second; no board counts as many

// In VirtualWheels::kRateParts of an edge per second.
std::int32_t full_rate(vm::Value full_speed, const vm::WheelEncoder& encoder, int percent) {
  const std::int64_t rate = std::int64_t{full_speed} * encoder.below / encoder.above;
  const std::int64_t bounded = std::min<std::int64_t>(rate, kMostRate);
  const std::int64_t rest = std::int64_t{full_speed} * encoder.below % encoder.above;
  const std::int64_t parts = bounded * policy::VirtualWheels::kRateParts +
                             rest * policy::VirtualWheels::kRateParts / encoder.above;
  return static_cast<std::int32_t>(parts * percent / 100);
}

}  // namespace

// The image must be verified.
void OutputGuard::own_encoders(const vm::Image& image, const vm::Actuator& drive,
                               const vm::DriveParameters& parameters) {
  counts_wheels_ = vm::has_encoders(parameters);
  if (!counts_wheels_) return;
  counted_drive_ = {};
  policy::VirtualWheels* const wheels = board_.wheels();
  for (std::size_t side = 0; side < vm::kSides.size(); ++side) {
    const auto encoder = vm::encoder_of(image, parameters, vm::kSides[side]);
    counts_wheels_ = counts_wheels_ && encoder;
    if (!encoder) continue;
    counted_drive_.encoders[side] = *encoder;
    const int slower = side == 0 ? 0 : vm::difference_of(drive);
    if (wheels != nullptr)
      wheels->begin(encoder->number, full_rate(parameters.speed, *encoder, 100 - slower),
                    static_cast<std::uint32_t>(kernel_.now()));
  }
}

void OutputGuard::count_wheels(kernel::Time now) {
  policy::EncoderCounts& counts = counted_drive_.counts;
  policy::VirtualWheels* const wheels = board_.wheels();
  for (std::size_t side = 0; side < counts.size(); ++side) {
    const unsigned number = counted_drive_.encoders[side].number;
    counts[side] = board_.edges_so_far(number);
    if (wheels != nullptr)
      counts[side].edges += wheels->edges(number, static_cast<std::uint32_t>(now));
  }
}

// With the power that its pin has now.
void OutputGuard::turn_virtual_wheel(const Slot& wheel, unsigned side, std::uint32_t now) {
  policy::VirtualWheels* const wheels = board_.wheels();
  if (wheels == nullptr) return;
  const vm::WheelEncoder& encoder = counted_drive_.encoders[side];
  const bool back = wheel.second && encoder.knows_direction;
  const std::int32_t pulse = wheel.pulse;
  wheels->turn(encoder.number, back ? -pulse : pulse, now);
}

}  // namespace robosync::guard
