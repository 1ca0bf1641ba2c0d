// See known_image.hpp. Port names make bad file names, and those of emulators are not reused: the file name is a hash of the port
// name modulo kPlaces, so a new line may overwrite the file of another.
#include "rsc/device/known_image.hpp"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "rsc/failure.hpp"
#include "rsc/files.hpp"
#include "rsc/output.hpp"
#include "vm/identity.hpp"

namespace robosync::tool {
namespace fs = std::filesystem;
namespace {

constexpr unsigned kPlaces = 64;

// Empty if this user has no cache folder.
fs::path file_of(const std::string& port) {
  const fs::path cache = cache_folder();
  if (cache.empty()) return {};
  const auto place = vm::crc32(std::as_bytes(std::span(port))) % kPlaces;
  return cache / "uploaded" / fmt::format("{:02}.rsb", place);
}

}  // namespace

std::vector<std::byte> known_image(const std::string& port) {
  const fs::path path = file_of(port);
  std::error_code error;
  if (path.empty() || !fs::is_regular_file(path, error)) return {};
  try {
    std::vector<std::byte> image = read_bytes(path);
    if (vm::is_named(image, {})) return image;
  } catch (const Failure&) {
    // Treated as missing.
  }
  return {};
}

void know_image(const std::string& port, std::span<const std::byte> image) {
  const fs::path path = file_of(port);
  if (path.empty()) return;
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  try {
    write_output(path, image);
  } catch (const Failure&) {
    // The next upload sends the whole image.
  }
}

}  // namespace robosync::tool
