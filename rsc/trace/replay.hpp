// Runs a recorded program again on this computer and feeds it the recorded readings at the same times. Nothing
// measures, and no algorithm runs: every reading is fed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rsc/trace/replay_file.hpp"

namespace robosync::tool {

struct Difference {
  std::size_t line = 0;            // of the recording; 0: not in it
  std::string recorded, replayed;  // as lines of a trace; empty: nothing
};

struct Replayed {
  std::uint64_t until_us = 0;  // program time of the last recorded event
  std::size_t events = 0;      // that were compared and equal
  std::size_t commands = 0;    // … of these
  std::size_t late = 0;  // … of these events: that the board reported later than this computer, …
  std::uint64_t latest_us = 0;  // … at most by so much
  std::size_t early =
      0;  // … of these events: what SAFETY did before the step that tells the reading, …
  std::uint64_t earliest_us = 0;  // … at most by so much
  std::optional<Difference> difference;
  // "touch.LEVEL": channels that a program run instead of the recorded one reads, and the recorded one did not. They
  // were not recorded, so they are unknown.
  std::vector<std::string> unrecorded;
};

// Compares what the program decides: rules, commands, variables, safety, messages; not late threads or silent
// devices, which depend on the board. `in_its_place`: if not empty, the image to run instead of the recorded one; its
// rules are then compared by number, not by line. Throws Failure (program) if the image is not valid, or the readings
// do not fit it.
[[nodiscard]] Replayed replay(const RecordedProgram& recorded, const std::string& file,
                              std::span<const std::byte> in_its_place = {});

}  // namespace robosync::tool
