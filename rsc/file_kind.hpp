// Tells what a file is from its content, so that a scenario is not read as a robot or overwritten by a trace.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace robosync::tool {

enum class FileKind : std::uint8_t {
  other,  // anything else; may be overwritten
  program,
  configuration,
  scenario,
  recording,  // CSV, with a column of times
  kept,
  trace,
  replay,  // a trace with its program, as --record writes it
  perfetto,
  key,      // of a robot's owner
  words,    // that were taught
  source,   // of a module
  library,  // a compiled module
  sound
};

// The first line of an owner's key.
inline constexpr std::string_view kKeyWords = "robosync owner's key, secret\n";

// The text may be incomplete or wrong: its beginning is enough. Never `program` or `source`, which only
// the file name tells.
[[nodiscard]] FileKind kind_of_text(std::string_view text);
// `other` when it cannot be read.
[[nodiscard]] FileKind kind_of_file(const std::filesystem::path& path);

// "a scenario".
[[nodiscard]] std::string_view describe(FileKind kind);

}  // namespace robosync::tool
