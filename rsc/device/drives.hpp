// Boards that show themselves as a drive.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace robosync::tool {

// The mount point of the drive of this name: a folder with that name, as desktops mount
// drives.
[[nodiscard]] std::optional<std::filesystem::path> mounted_drive(const std::string& label);
// The same from a list of mounts in the format of /proc/self/mounts.
[[nodiscard]] std::optional<std::filesystem::path> drive_among(std::string_view mounts,
                                                               const std::string& label);

}  // namespace robosync::tool
