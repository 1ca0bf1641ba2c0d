// The readings of a recording.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "rsc/trace/replay_file.hpp"
#include "vm/image.hpp"

namespace robosync::tool {

struct Told {
  std::uint64_t at_us = 0;
  std::uint64_t step = 0;
  std::uint8_t channel = 0;
  std::optional<vm::Value> value;  // nothing: the channel became silent
  bool came_earlier = false;       // than the step that tells it
};
using Readings = std::vector<Told>;  // in their order

// As channels of `image`, by name. Throws Failure (program), with `file` and line, for one that does not fit.
[[nodiscard]] Readings readings_of(const RecordedProgram& recorded, const vm::Image& image,
                                   const std::string& file);

// The channels that became silent.
[[nodiscard]] std::set<std::uint8_t> silent_ones(const Readings& readings);

}  // namespace robosync::tool
