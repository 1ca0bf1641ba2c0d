// What the verifier cannot know about an image's algorithms: whether this firmware has their modules, and whether
// these accept their inputs, parameters and outputs. Pure; the board and rsc call it for each image that verify() has
// accepted.
#pragma once

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
inline const std::int32_t* config_of(const vm::Image& image, const vm::Sensor& algorithm) {
  return image.constants.data() + algorithm.address;
}

}  // namespace robosync::algorithms
