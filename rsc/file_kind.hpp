// What a file is, by what stands in it: so that a scenario is not read as a robot, nor written over by a trace.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace robosync::tool {

enum class FileKind : std::uint8_t {
  other,  // may be anything, and be made again
  program,
  configuration,
  scenario,
  recording,  // CSV, with a column of times
  kept,
  trace,
  perfetto
};

// Of a text that need not be whole or right: its beginning is enough. Never `program`, which only a name tells.
[[nodiscard]] FileKind kind_of_text(std::string_view text);
// `other` when it cannot be read.
[[nodiscard]] FileKind kind_of_file(const std::filesystem::path& path);

// "a scenario".
[[nodiscard]] std::string_view describe(FileKind kind);

}  // namespace robosync::tool
