// Boards that show themselves as a drive.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace robosync::tool {

// Where the drive of this name is mounted: a folder that is called so, as desktops do it.
[[nodiscard]] std::optional<std::filesystem::path> mounted_drive(const std::string& label);
// The same in a list of mounts, as /proc/self/mounts has it.
[[nodiscard]] std::optional<std::filesystem::path> drive_among(std::string_view mounts,
                                                               const std::string& label);

}  // namespace robosync::tool
