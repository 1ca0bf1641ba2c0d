// Recordings that `rsc replay` runs again: the lines of a trace
// (trace_format.hpp), and among them
//   {"event":"image","bytes":400,"hex":"…"}   the program that begins, or goes
//   on, from here; before its `activated`
//   {"event":"gap","why":"…"}                 something has happened that the
//   recording does not tell
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace robosync::tool {

// Each with its newline.
[[nodiscard]] std::string image_line(std::span<const std::byte> image);
[[nodiscard]] std::string whole_line();
[[nodiscard]] std::string gap_line(const std::string& why);

// NOLINTNEXTLINE(bugprone-exception-escape): JSON ends itself with memory of its own
struct RecordedEvent {
  std::size_t line = 0;  // of the file
  nlohmann::ordered_json event;
};

// What was recorded of one program from its beginning on, without a gap.
struct RecordedProgram {
  std::size_t line = 0;          // where it begins
  std::vector<std::byte> image;  // empty: the file does not have it
  std::vector<RecordedEvent> events;
  std::string gap;  // why it ends; empty: it was there to the end
};

struct RecordedRun {
  std::vector<RecordedProgram> programs;
  std::size_t loose = 0;  // events before a beginning, or behind a gap: nobody
                          // knows what led to them
};

// Throws as read_trace(); Failure (program), with file and line, for an image
// that is none.
[[nodiscard]] RecordedRun read_recording(const std::string& file);

}  // namespace robosync::tool
