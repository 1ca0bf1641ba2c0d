// Runs what was recorded of a program again, on this computer: what its sensors
// said then, it is told now, at the same times. Whatever measured them, they
// are told by a feed; nothing measures, and no algorithm runs.
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
  std::size_t line = 0;            // of the recording; 0: it does not have it
  std::string recorded, replayed;  // as lines of a trace; empty: nothing
};

struct Replayed {
  std::uint64_t until_us = 0;  // program time of the last thing that was recorded
  std::size_t events = 0;      // that were compared, and were the same
  std::size_t commands = 0;    // … of these
  std::size_t late = 0;  // … of these events: that the board told later than this computer, …
  std::uint64_t latest_us = 0;  // … at most by so much
  std::optional<Difference> difference;
  // "touch.LEVEL": what a program in place of the recorded one reads and that one did not. Nobody has recorded it, so
  // it was unknown.
  std::vector<std::string> unrecorded;
};

// Compared is what the program decides: rules, commands, variables, safety,
// messages; not when a thread was late or a device silent, which a recording
// tells of its board. `in_its_place`: the image of a program that runs instead
// of the recorded one, if it is not empty; the lines at which its rules stand
// are not compared then, their numbers are. Throws Failure (program) when the
// image that runs is none, or the readings are not of it.
[[nodiscard]] Replayed replay(const RecordedProgram& recorded, const std::string& file,
                              std::span<const std::byte> in_its_place = {});

}  // namespace robosync::tool
