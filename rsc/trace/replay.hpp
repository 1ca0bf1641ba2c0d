// Runs what was recorded of a program again, on this computer: what its sensors
// said then, it is told now, at the same times. Whatever measured them, they
// are told by a feed; nothing measures, and no algorithm runs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

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
  std::optional<Difference> difference;
};

// Compared is what the program decides: rules, commands, variables, safety,
// messages; not when a thread was late or a device silent, which a recording
// tells of its board. Throws Failure (program) when its image is none, or its
// readings are not of it.
[[nodiscard]] Replayed replay(const RecordedProgram& recorded, const std::string& file);

}  // namespace robosync::tool
