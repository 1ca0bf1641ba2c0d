// Files: whole, with messages that name them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace robosync::tool {

// Both throw Failure (outside) when the file cannot be read, or is larger than 16 MiB.
[[nodiscard]] std::string read_text(const std::filesystem::path& path);
[[nodiscard]] std::vector<std::byte> read_bytes(const std::filesystem::path& path);

// `config` if it is not empty, else STEM.json beside `program`, else robot.json beside it. Throws
// Failure (outside) when there is none.
[[nodiscard]] std::filesystem::path find_configuration(const std::filesystem::path& program,
                                                       const std::string& config);

}  // namespace robosync::tool
