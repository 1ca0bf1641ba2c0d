// The library modules as files, since editors can only show files.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace robosync::tool::lsp {

// The path of a copy of module `<name>`, written if missing. Nothing if there is no such module, or no folder for it.
[[nodiscard]] std::optional<std::filesystem::path> library_file(std::string_view name);
[[nodiscard]] bool is_in_library_folder(const std::filesystem::path& path);

}  // namespace robosync::tool::lsp
