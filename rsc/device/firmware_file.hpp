// The files of a firmware, robosync-BOARD.hex, .bin and .elf (scripts/firmware): the same in three forms.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace robosync::tool {

// `file` if its extension is one of `endings`, else the file next to it with the first of them that exists. Without `file`:
// robosync-BOARD in this folder, in build/firmware, or installed with the tool. Throws Failure (outside) if there is none, or
// if it is not the firmware of `board`.
[[nodiscard]] std::filesystem::path find_firmware(const std::string& file, const std::string& board,
                                                  const std::vector<std::string_view>& endings);

}  // namespace robosync::tool
