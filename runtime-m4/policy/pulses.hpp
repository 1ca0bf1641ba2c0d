// The pulse on the pin of an actuator at rest. Pure. Actuators are of verified images.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "vm/drivers.hpp"
#include "vm/image.hpp"

namespace robosync::policy {

// Where an actuator rests: at 0, or at the position of its range nearest to 0.
constexpr vm::Value rest_position(const vm::Actuator& actuator) {
  return std::clamp(vm::Value{0}, actuator.min, actuator.max);
}

// The pulse of a servo at `position`, which is in its range, in microseconds.
constexpr std::uint32_t pulse_at(const vm::Actuator& servo, vm::ServoPulses pulses,
                                 vm::Value position) {
  const std::int64_t span = std::int64_t{servo.max} - servo.min;
  const std::int64_t way = std::int64_t{position} - servo.min;
  const std::int32_t longer = pulses.at_max - pulses.at_min;
  const std::int64_t pulse = span == 0 ? longer / 2 : way * longer / span;
  return static_cast<std::uint32_t>(pulses.at_min + pulse);
}

// The pulse, in microseconds, that puts an actuator on a pin into its safe state; 0 for off. None: keep the
// current pulse, so that the actuator stays where it is.
constexpr std::optional<std::uint32_t> safe_pulse(const vm::Actuator& actuator,
                                                  vm::ServoPulses pulses) {
  if (!vm::is_servo(actuator.driver)) return 0;
  if (actuator.safe == vm::Release::coast) return 0;
  if (actuator.safe == vm::Release::hold) return std::nullopt;
  return pulse_at(actuator, pulses, rest_position(actuator));
}

}  // namespace robosync::policy
