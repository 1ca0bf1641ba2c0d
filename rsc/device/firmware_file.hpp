// The files of a firmware, robosync-BOARD.hex, .bin and .elf (scripts/firmware): the same in three forms.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace robosync::tool {

// `file` if its ending is one of `endings`, else the one beside it that has the first of them that is there. Without `file`:
// robosync-BOARD in this folder, in build/firmware, or installed with the tool. Throws Failure (outside) when there is none, or
// when it is not the firmware of `board`.
[[nodiscard]] std::filesystem::path find_firmware(const std::string& file, const std::string& board,
                                                  const std::vector<std::string_view>& endings);

}  // namespace robosync::tool
