// What encoders count, also of the wheels that a board without any pretends to have: see output_guard.hpp.
#include <algorithm>
#include <cstdint>

#include "runtime-m4/guard/output_guard.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::guard {
namespace {

using policy::VirtualWheels;

// In VirtualWheels::kRateParts of an edge per second; no board counts as many as its kMostRate.
std::int32_t full_rate(vm::Value full_speed, const vm::WheelEncoder& encoder, int percent) {
  const std::int64_t parts =
      std::int64_t{full_speed} * encoder.below * VirtualWheels::kRateParts / encoder.above;
  return static_cast<std::int32_t>(std::min(parts * percent / 100, VirtualWheels::kMostRate));
}

}  // namespace

// The image must be verified. Not inline: a program is started on the deepest path of the link's stack.
[[gnu::noinline]] void OutputGuard::own_encoders(const vm::Image& image, const vm::Actuator& drive,
                                                 const vm::DriveParameters& parameters) {
  counts_wheels_ = vm::has_encoders(parameters);
  if (!counts_wheels_) return;
  counted_drive_ = {};
  VirtualWheels* const wheels = board_.wheels();
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

// Under the lock, as a halt may turn virtual wheels at any time.
void OutputGuard::count_wheels(kernel::Time now) {
  const auto lock = kernel_.lock();
  policy::EncoderCounts& counts = counted_drive_.counts;
  const VirtualWheels* const wheels = board_.wheels();
  for (std::size_t side = 0; side < counts.size(); ++side) {
    const unsigned number = counted_drive_.encoders[side].number;
    counts[side] = board_.edges_so_far(number);
    if (wheels != nullptr)
      counts[side].edges += wheels->edges(number, static_cast<std::uint32_t>(now));
  }
}

bool OutputGuard::take_edges(const vm::Sensor& sensor, unsigned number, kernel::Time time,
                             boards::Turned& turned) {
  const auto lock = kernel_.lock();
  const unsigned most = policy::most_edges(sensor.period_ms);
  const bool all = board_.take_edges(number, sensor.address, sensor.bus, most, turned);
  const VirtualWheels* const wheels = board_.wheels();
  if (wheels == nullptr || !wheels->is_on(number)) return all;
  const auto now = static_cast<std::uint32_t>(time);
  turned.edges += wheels->edges(number, now);
  turned.ago = wheels->ago(number, now);
  return all;
}

// With the power that their pins have now. Not inline: put_wheels() calls it last, so the two are not on the stack together.
[[gnu::noinline]] void OutputGuard::turn_virtual_wheels(unsigned actuator, std::uint32_t now) {
  VirtualWheels* const wheels = board_.wheels();
  if (wheels == nullptr) return;
  for (std::size_t side = 0; side < vm::kSides.size(); ++side) {
    const Slot& slot = side == 0 ? slots_[actuator] : right_wheel_;
    const vm::WheelEncoder& encoder = counted_drive_.encoders[side];
    const bool back = slot.second && encoder.knows_direction;
    const std::int32_t pulse = slot.pulse;
    wheels->turn(encoder.number, back ? -pulse : pulse, now);
  }
}

}  // namespace robosync::guard
