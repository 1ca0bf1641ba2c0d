// May assume POSIX. Promises whole files or a message that names the file and the reason.
#include "rsc/files.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <span>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "rsc/file_kind.hpp"

namespace robosync::tool {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxFile = std::size_t{16} * 1024 * 1024;
constexpr std::size_t kReadBlock = std::size_t{64} * 1024;
constexpr std::size_t kMostEntries = 2000;

[[noreturn]] void fail(const char* what, const fs::path& path, int error) {
  throw Failure(Exit::outside,
                fmt::format("cannot {} {}: {}", what, path.string(), std::strerror(error)));
}

// A file that is read sequentially; may be a pipe.
class InputFile {
public:
  explicit InputFile(const fs::path& path)
      : path_(path), file_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (file_ < 0 && errno == ENOENT && path_ == "-")
      throw Failure(Exit::outside, "cannot read -: only rsc check and rsc fmt read stdin");
    if (file_ < 0) fail("read", path_, errno);
  }
  ~InputFile() { close(file_); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  // The size of the file, up to the limit; only a hint for pipes and growing files.
  std::size_t size_hint() const {
    struct stat facts {};
    if (fstat(file_, &facts) != 0 || facts.st_size < 0) return 0;
    return std::min(static_cast<std::size_t>(facts.st_size), kMaxFile);
  }

  // Fills `room`, unless the file ends first. Returns the bytes read.
  std::size_t read_some(std::span<char> room) const {
    std::size_t done = 0;
    while (done < room.size()) {
      const ssize_t count = read(file_, room.data() + done, room.size() - done);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail("read", path_, errno);
      if (count == 0) break;
      done += static_cast<std::size_t>(count);
    }
    return done;
  }

private:
  fs::path path_;
  int file_;
};

}  // namespace

std::string read_text(const fs::path& path) {
  const InputFile file(path);
  std::string text;
  // One byte more than the file has, to see its end without another read.
  for (std::size_t room = file.size_hint() + 1;; room = kReadBlock) {
    const std::size_t before = text.size();
    text.resize(before + room);
    text.resize(before + file.read_some(std::span(text).subspan(before)));
    if (text.size() > kMaxFile) fail("read", path, EFBIG);
    if (text.size() < before + room) return text;
  }
}

std::vector<std::byte> read_bytes(const fs::path& path) {
  const std::string text = read_text(path);
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::vector<fs::path> files_in(const fs::path& folder, std::string_view extension) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (std::size_t entries = 0;
       !error && entry != fs::directory_iterator() && entries < kMostEntries;
       ++entries, entry.increment(error))
    if (entry->path().extension() == extension) files.push_back(entry->path().lexically_normal());
  return files;
}

fs::path cache_folder() {
  const char* const cache = std::getenv("XDG_CACHE_HOME");
  const char* const home = std::getenv("HOME");
  fs::path base;
  if (cache != nullptr && fs::path(cache).is_absolute()) base = cache;
  if (base.empty() && home != nullptr && fs::path(home).is_absolute())
    base = fs::path(home) / ".cache";
  return base.empty() ? base : (base / "robosync").lexically_normal();
}

Exit for_each_file(const std::vector<std::string>& files,
                   const std::function<void(const std::string&)>& work) {
  Exit worst = Exit::fine;
  for (const std::string& file : files) {
    try {
      work(file);
    } catch (const Failure& failure) {
      std::cout.flush();
      if (*failure.what() != '\0') std::cerr << "rsc: " << failure.what() << '\n';
      worst = std::max(worst, failure.exit());
    }
  }
  return worst;
}

std::string Texts::read(const fs::path& path) const {
  return read_text(path);
}

bool Texts::has(const fs::path& path) const {
  std::error_code error;
  return fs::exists(path, error);
}

std::vector<fs::path> places_of_configuration(const fs::path& program, const std::string& config) {
  if (!config.empty()) return {config};
  fs::path by_stem = program;
  by_stem.replace_extension(".json");
  return {by_stem, program.parent_path() / "robot.json"};
}

namespace {

// Its errors as a configuration would be misleading.
void refuse_what_is_none(const fs::path& place, const fs::path& program, const Texts& texts) {
  const FileKind kind = kind_of_text(texts.read(place));
  if (kind == FileKind::other || kind == FileKind::configuration) return;
  throw Failure(Exit::program,
                fmt::format("{} is {}, but its name makes it the configuration of {}: rename it, "
                            "or name the configuration with --config FILE",
                            place.string(), describe(kind), program.string()));
}

}  // namespace

fs::path find_configuration(const fs::path& program, const std::string& config,
                            const Texts& texts) {
  if (!config.empty()) return config;
  const std::vector<fs::path> places = places_of_configuration(program, config);
  for (const fs::path& place : places) {
    if (!texts.has(place)) continue;
    refuse_what_is_none(place, program, texts);
    return place;
  }
  throw Failure(Exit::outside,
                fmt::format("no configuration for {}: there is no {} and no {}; name one with "
                            "--config FILE",
                            program.string(), places[0].string(), places[1].string()));
}

}  // namespace robosync::tool
