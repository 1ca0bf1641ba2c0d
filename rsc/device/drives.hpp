// Boards that show themselves as a drive.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace robosync::tool {

// Where the drive of this name is mounted: a folder that is called so, as desktops do it.
[[nodiscard]] std::optional<std::filesystem::path> mounted_drive(const std::string& label);
// The same in a list of mounts, as /proc/self/mounts has it.
[[nodiscard]] std::optional<std::filesystem::path> drive_among(std::string_view mounts,
                                                               const std::string& label);

// As it is, and all of it at once there: a board that is a drive knows no other files and no renaming. Throws Failure (outside).
void write_to_drive(const std::filesystem::path& file, std::span<const std::byte> bytes);

}  // namespace robosync::tool
