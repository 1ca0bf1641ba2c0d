// The modules of the library as files: an editor can show nothing else.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace robosync::tool::lsp {

// A copy of the module `<name>`, written when it is not there. Nothing when there is no such module, or no place for it.
[[nodiscard]] std::optional<std::filesystem::path> library_file(std::string_view name);
[[nodiscard]] bool is_in_library_folder(const std::filesystem::path& path);

}  // namespace robosync::tool::lsp
