// Which threads a program has, and which behaviours need each: what a thread is worth is the most
// that a behaviour that needs it is worth. Pure; the runtime starts and ranks threads by it,
// analysis/ works out who outranks whom. Images are verified: behaviours stand from the highest
// priority down, the SAFETY rules first.
#pragma once

#include <algorithm>
#include <cstdint>

#include "runtime-m4/policy/standing.hpp"
#include "vm/image.hpp"

namespace robosync::policy {

// --- sensors ---

inline constexpr vm::DriverId kFedDriver = vm::DriverId::virtual_sensor;

// Its readings come from outside, at any time: it is not sampled.
constexpr bool is_fed(const vm::Sensor& sensor) {
  return sensor.period_ms == 0 || sensor.driver == kFedDriver;
}

inline bool has_fed_sensors(const vm::Image& image) {
  return std::ranges::any_of(image.sensors, is_fed);
}

// In the place of a sensor: all that are fed, which one thread serves. It is started after those of
// the sensors that are sampled, which have one each, in the order of the image.
inline constexpr unsigned kFedSensors = 0xFF;

// The thread that serves a sensor: named after the sensor, or kFedSensors.
inline unsigned thread_of(const vm::Image& image, unsigned sensor) {
  return is_fed(image.sensors[sensor]) ? kFedSensors : sensor;
}

// --- behaviours ---

// The first that is not the SAFETY rules.
inline unsigned first_behavior(const vm::Image& image) {
  return image.has_safety() ? vm::kSafetyBehavior + 1U : 0;
}

// Of threads that no behaviour needs: below all that one does.
inline std::int8_t idle_priority(const vm::Image& image) {
  if (image.behaviors.empty()) return 0;
  return static_cast<std::int8_t>(image.behaviors.back().priority - 1);
}

// Does `behavior` need a thread of this category? `index` is that of its behaviour or actuator;
// `reads`: of a sensor's thread, that the behaviour reads one of its channels.
inline bool needs(const vm::Image& image, unsigned behavior, Category category, unsigned index,
                  bool reads) {
  switch (category) {
    case Category::sensor:
      return reads;
    case Category::behavior:
      return behavior == index;
    case Category::control:  // the safety monitor needs no thread to halt one
      return behavior >= first_behavior(image) &&
             (image.behaviors[behavior].actuators >> index & 1) != 0;
    case Category::processing:
      return true;
    default:
      return false;
  }
}

}  // namespace robosync::policy
