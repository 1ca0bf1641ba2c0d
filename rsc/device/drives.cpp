// See drives.hpp. Linux lists mounts in a file; macOS has a folder of them.
#include "rsc/device/drives.hpp"

#include <fstream>
#include <iterator>
#include <sstream>

namespace robosync::tool {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kOctal = 3;  // octal digits: "\040" is a space

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

}  // namespace robosync::tool
