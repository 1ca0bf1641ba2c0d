#include "rsc/lsp/library.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <system_error>

#include "compiler/modules.hpp"
#include "rsc/failure.hpp"
#include "rsc/files.hpp"
#include "rsc/output.hpp"

namespace robosync::tool::lsp {
namespace fs = std::filesystem;
namespace {

// Empty if this user has no cache folder.
fs::path library_folder() {
  const fs::path cache = cache_folder();
  return cache.empty() ? cache : cache / ("stdlib-" ROBOSYNC_VERSION);
}

bool has_text(const fs::path& path, std::string_view text) {
  try {
    return read_text(path) == text;
  } catch (const Failure&) {
    return false;
  }
}

}  // namespace

std::optional<fs::path> library_file(std::string_view name) {
  const auto modules = compiler::module_texts();
  const auto is_named = [&](const compiler::ModuleText& module) {
    return name == "<" + std::string(module.name) + ">";
  };
  const auto found = std::ranges::find_if(modules, is_named);
  const fs::path folder = library_folder();
  if (found == modules.end() || folder.empty()) return std::nullopt;
  fs::path path = folder / (std::string(found->name) + ".rsl");
  if (has_text(path, found->text)) return path;
  std::error_code error;
  fs::create_directories(folder, error);
  try {
    write_output(path.string(), std::as_bytes(std::span(found->text)));
  } catch (const Failure&) {
    return std::nullopt;
  }
  return path;
}

bool is_in_library_folder(const fs::path& path) {
  const fs::path folder = library_folder();
  return !folder.empty() && path.parent_path() == folder;
}

}  // namespace robosync::tool::lsp
