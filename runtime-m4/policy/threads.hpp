// Which threads a program has, and which behaviours need each: a thread has the highest priority of
// the behaviours that need it. Pure. The runtime starts and ranks threads by it, and analysis/ derives
// which thread outranks which. Images are verified: behaviours are in order of falling priority, with
// the SAFETY rules first.
#pragma once

#include <algorithm>
#include <cstdint>

#include "runtime-m4/policy/standing.hpp"
#include "vm/image.hpp"

namespace robosync::policy {

// --- sensors ---

inline constexpr vm::DriverId kFedDriver = vm::DriverId::virtual_sensor;

// Its readings are computed from those of another sensor: it is neither sampled nor fed.
constexpr bool is_algorithm(const vm::Sensor& sensor) {
  return sensor.driver == vm::DriverId::algorithm;
}

// Its readings come from outside, at any time: it is not sampled.
constexpr bool is_fed(const vm::Sensor& sensor) {
  return !is_algorithm(sensor) && (sensor.period_ms == 0 || sensor.driver == kFedDriver);
}

inline bool has_fed_sensors(const vm::Image& image) {
  return std::ranges::any_of(image.sensors, is_fed);
}

inline bool has_algorithms(const vm::Image& image) {
  return std::ranges::any_of(image.sensors, is_algorithm);
}

// The sensor that an algorithm reads.
inline unsigned input_of(const vm::Image& image, const vm::Sensor& algorithm) {
  return image.channels[algorithm.first_input].sensor;
}

// Used as a sensor number, means all fed sensors, which share one thread. It is started after the
// threads of the sampled sensors, which have one each, in the order of the image.
inline constexpr unsigned kFedSensors = 0xFE;
// Used as a sensor number, means all algorithms. One thread, started after those of the sensors, passes readings to
// the modules' threads and results back. The modules' threads have the same priority, and outrank it by category.
inline constexpr unsigned kAlgorithms = 0xFF;

// The thread that serves a sensor: the sensor's number, or kFedSensors, or kAlgorithms.
inline unsigned thread_of(const vm::Image& image, unsigned sensor) {
  if (is_algorithm(image.sensors[sensor])) return kAlgorithms;
  return is_fed(image.sensors[sensor]) ? kFedSensors : sensor;
}

// Does an algorithm use what this thread measures? Then the behaviours that read an algorithm need the thread too,
// so it never ranks below the threads that wait for its readings.
inline bool feeds_algorithm(const vm::Image& image, unsigned sensor_thread) {
  return std::ranges::any_of(image.sensors, [&](const vm::Sensor& algorithm) {
    return is_algorithm(algorithm) && thread_of(image, input_of(image, algorithm)) == sensor_thread;
  });
}

// Calls take(channel) for the channels whose readers need the thread.
template <class Take>
void each_channel_of_thread(const vm::Image& image, unsigned sensor_thread, Take take) {
  const bool feeds = sensor_thread != kAlgorithms && feeds_algorithm(image, sensor_thread);
  for (unsigned s = 0; s < image.sensors.size(); ++s) {
    const vm::Sensor& sensor = image.sensors[s];
    if (thread_of(image, s) == sensor_thread || (feeds && is_algorithm(sensor)))
      for (unsigned i = 0; i < sensor.channel_count; ++i)
        take(sensor.first_channel + i);
  }
}

// --- behaviours ---

// The first behaviour after the SAFETY rules.
inline unsigned first_behavior(const vm::Image& image) {
  return image.has_safety() ? vm::kSafetyBehavior + 1U : 0;
}

// The priority of threads that no behaviour needs: below that of all others.
inline std::int8_t idle_priority(const vm::Image& image) {
  if (image.behaviors.empty()) return 0;
  return static_cast<std::int8_t>(image.behaviors.back().priority - 1);
}

// Does `behavior` need a thread of this category? `index`: the thread's behaviour or actuator.
// `reads`: for a sensor's or an algorithm's thread, whether the behaviour reads one of its channels.
inline bool needs(const vm::Image& image, unsigned behavior, Category category, unsigned index,
                  bool reads) {
  switch (category) {
    case Category::sensor:
    case Category::algorithm:
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
