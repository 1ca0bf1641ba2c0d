// What the verifier cannot know about an image's algorithms: whether this firmware has their modules, and whether
// these accept their inputs, parameters and outputs. Pure; the board and rsc call it for each image that verify() has
// accepted.
#pragma once

#include <span>

#include "runtime-m4/algorithms/modules.hpp"
#include "vm/image.hpp"
#include "vm/verifier.hpp"

namespace robosync::algorithms {

[[nodiscard]] vm::Verdict judge(const vm::Image& image);

// For an algorithm's record in a judged image.
inline const robosync_module& module_of(const vm::Sensor& algorithm) {
  return *find_module(algorithm.bus);
}
// Where a module's scratch begins in its memory, after its state.
inline std::uint32_t scratch_at(const robosync_module& module, const std::int32_t* config) {
  return (module.state_bytes(config) + 7U) & ~7U;
}
// The most bytes that state and scratch may take together.
inline std::uint32_t most_bytes(const vm::Sensor& algorithm) {
  return std::uint32_t{ROBOSYNC_MOST_BYTES} + std::uint32_t{ROBOSYNC_ROOM} * algorithm.room;
}
inline const std::int32_t* config_of(const vm::Image& image, const vm::Sensor& algorithm) {
  return image.constants.data() + algorithm.address;
}

// What a module was taught: constants that follow its parameters, and how many they are.
inline std::span<const vm::Value> constants_of(const vm::Image& image,
                                               const vm::Sensor& algorithm) {
  const std::size_t place = algorithm.address + std::size_t{module_of(algorithm).parameters};
  return image.constants.subspan(place + 1, static_cast<std::size_t>(image.constants[place]));
}

}  // namespace robosync::algorithms
