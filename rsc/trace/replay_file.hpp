// Recordings for `rsc replay`: the lines of a trace (trace_format.hpp), and among them
//   {"event":"image","bytes":400,"hex":"…"}   the program that starts or keeps running here; before its `activated`
//   {"event":"gap","why":"…"}                 events are missing here
//   {"event":"whole"}                         no events are missing up to here
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "rsc/json.hpp"

namespace robosync::tool {

// Each ends with a newline.
[[nodiscard]] std::string image_line(std::span<const std::byte> image);
[[nodiscard]] std::string whole_line();
[[nodiscard]] std::string gap_line(const std::string& why);

// NOLINTNEXTLINE(bugprone-exception-escape): JSON ends itself with memory of its own
struct RecordedEvent {
  std::size_t line = 0;  // of the file
  Json event;
};

// The recording of one program from its start, up to the first gap.
struct RecordedProgram {
  std::size_t line = 0;          // where it starts
  std::vector<std::byte> image;  // empty: the file does not have it
  std::vector<RecordedEvent> events;
  std::string gap;  // why it ends early; empty: it is complete
};

struct RecordedRun {
  std::vector<RecordedProgram> programs;
  std::size_t loose = 0;  // events before a program's start or after a gap: causes unknown
};

// Throws what read_trace() throws; Failure (program), with file and line, for an invalid image.
[[nodiscard]] RecordedRun read_recording(const std::string& file);

}  // namespace robosync::tool
