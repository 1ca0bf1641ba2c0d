// See firmware_file.hpp. A firmware file contains the name of its board.
#include "rsc/device/firmware_file.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "rsc/failure.hpp"
#include "rsc/files.hpp"

namespace robosync::tool {
namespace fs = std::filesystem;
namespace {

// The data of Intel HEX: lines of ":LLAAAATT", LL bytes, a checksum.
std::string content_of_hex(const std::string& text) {
  constexpr std::size_t kHead = 9, kPerByte = 2;
  std::string bytes;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool is_data = line.starts_with(':') && line.size() > kHead && line.substr(7, 2) == "00";
    if (!is_data) continue;
    for (std::size_t at = kHead; at + 2 * kPerByte <= line.size(); at += kPerByte) {
      unsigned byte = 0;
      std::from_chars(line.data() + at, line.data() + at + kPerByte, byte, 16);
      bytes += static_cast<char>(byte);
    }
  }
  return bytes;
}

void check_board(const fs::path& file, const std::string& board) {
  std::string content = read_text(file);
  if (file.extension() == ".hex") content = content_of_hex(content);
  if (content.find(board) != std::string::npos) return;
  throw Failure(Exit::outside, fmt::format("{} is not the firmware of {}: it does not contain that "
                                           "name; `scripts/firmware {}` makes one",
                                           file.string(), board, board));
}

std::optional<fs::path> with_ending(const fs::path& stem,
                                    const std::vector<std::string_view>& endings) {
  for (const std::string_view ending : endings) {
    const fs::path file = stem.string() + std::string(ending);
    std::error_code error;
    if (fs::is_regular_file(file, error)) return file;
  }
  return std::nullopt;
}

// Where the package installs it, relative to the tool.
fs::path installed_firmware() {
  std::error_code error;
  const fs::path tool = fs::read_symlink("/proc/self/exe", error);
  return tool.parent_path().parent_path() / "share/robosync/firmware";
}

// The named file, or one next to it with another extension.
std::optional<fs::path> named(const fs::path& file, const std::vector<std::string_view>& endings) {
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    throw Failure(Exit::outside, file.string() + ": there is no such file");
  if (std::ranges::find(endings, file.extension().string()) != endings.end()) return file;
  return with_ending(file.parent_path() / file.stem(), endings);
}

}  // namespace

fs::path find_firmware(const std::string& file, const std::string& board,
                       const std::vector<std::string_view>& endings) {
  const std::string usual = "robosync-" + board;
  std::optional<fs::path> found;
  if (!file.empty()) {
    found = named(file, endings);
  } else {
    found = with_ending(usual, endings);
    if (!found) found = with_ending(fs::path("build/firmware") / usual, endings);
    if (!found) found = with_ending(installed_firmware() / usual, endings);
  }
  if (!found) {
    throw Failure(
        Exit::outside,
        file.empty()
            ? fmt::format("there is no {}{} here, in build/firmware or in {}: name the file, or "
                          "make it with `scripts/firmware {}`",
                          usual, endings.front(), installed_firmware().string(), board)
            : fmt::format("{}: a {} file is needed, and there is none next to it", file,
                          endings.front()));
  }
  check_board(*found, board);
  return *found;
}

}  // namespace robosync::tool
