// file:// URIs and paths.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace robosync::tool::lsp {

// The path of a file URI; nothing for any other URI.
[[nodiscard]] std::optional<std::filesystem::path> path_of(std::string_view uri);
[[nodiscard]] std::string uri_of(const std::filesystem::path& path);

}  // namespace robosync::tool::lsp
