// See drives.hpp. Linux lists what is mounted in a file; macOS has a folder of it.
#include "rsc/device/drives.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "rsc/failure.hpp"

namespace robosync::tool {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kOctal = 3;  // digits: "\040" is a space

std::string unescaped(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::string digits = text[i] == '\\' ? text.substr(i + 1, kOctal) : std::string();
    if (digits.size() == kOctal && digits.find_first_not_of("01234567") == std::string::npos) {
      result += static_cast<char>(std::stoi(digits, nullptr, 8));
      i += kOctal;
    } else {
      result += text[i];
    }
  }
  return result;
}

}  // namespace

std::optional<fs::path> drive_among(std::string_view mounts, const std::string& label) {
  std::istringstream lines{std::string(mounts)};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string device, place;
    words >> device >> place;
    const fs::path path = unescaped(place);
    if (path.filename() == label) return path;
  }
  return std::nullopt;
}

std::optional<fs::path> mounted_drive(const std::string& label) {
  std::ifstream file("/proc/self/mounts");
  const std::string mounts{std::istreambuf_iterator<char>(file), {}};
  if (auto found = drive_among(mounts, label)) return found;
  std::error_code error;
  const fs::path volume = fs::path("/Volumes") / label;
  if (fs::is_directory(volume, error)) return volume;
  return std::nullopt;
}

void write_to_drive(const fs::path& file, std::span<const std::byte> bytes) {
  constexpr mode_t kNewFile = 0666;
  const int number = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kNewFile);
  bool good = number >= 0;
  while (good && !bytes.empty()) {
    const ssize_t count = write(number, bytes.data(), bytes.size());
    if (count >= 0)
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    else
      good = errno == EINTR;
  }
  good = good && fsync(number) == 0;
  const int why = errno;
  if (number >= 0) close(number);
  if (!good)
    throw Failure(Exit::outside,
                  fmt::format("cannot write {}: {}", file.string(), std::strerror(why)));
}

}  // namespace robosync::tool
