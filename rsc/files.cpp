// May assume POSIX. Promises whole files or a message that names the file and the reason.
#include "rsc/files.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "rsc/failure.hpp"

namespace robosync::tool {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxFile = std::size_t{16} * 1024 * 1024;

[[noreturn]] void fail(const char* what, const fs::path& path, int error) {
  throw Failure(Exit::outside,
                fmt::format("cannot {} {}: {}", what, path.string(), std::strerror(error)));
}

// A temporary file beside the one to be written. Gone unless it was renamed.
class Temporary {
public:
  explicit Temporary(const fs::path& target)
      : target_(target), name_(target.string() + ".XXXXXX"), file_(mkstemp(name_.data())) {
    if (file_ < 0) fail("write", target_, errno);
  }
  ~Temporary() {
    if (file_ >= 0) close(file_);
    if (!renamed_) unlink(name_.c_str());
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  void write_all(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const ssize_t count = write(file_, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail("write", target_, errno);
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
  }

  void replace_target() {
    const mode_t mask = umask(0);
    umask(mask);
    if (fchmod(file_, 0666 & ~mask) != 0 || fsync(file_) != 0 ||
        std::rename(name_.c_str(), target_.c_str()) != 0) {
      fail("write", target_, errno);
    }
    renamed_ = true;
  }

private:
  fs::path target_;
  std::string name_;
  int file_;
  bool renamed_ = false;
};

}  // namespace

std::string read_text(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) fail("read", path, EISDIR);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) fail("read", path, errno != 0 ? errno : EIO);
  std::string text(kMaxFile + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) fail("read", path, EIO);
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kMaxFile) fail("read", path, EFBIG);
  return text;
}

std::vector<std::byte> read_bytes(const fs::path& path) {
  const std::string text = read_text(path);
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

void write_atomically(const fs::path& path, std::span<const std::byte> bytes) {
  Temporary file(path);
  file.write_all(bytes);
  file.replace_target();
}

fs::path find_configuration(const fs::path& program, const std::string& config) {
  if (!config.empty()) return config;
  fs::path by_stem = program;
  by_stem.replace_extension(".json");
  std::error_code error;
  if (fs::exists(by_stem, error)) return by_stem;
  fs::path common = program.parent_path() / "robot.json";
  if (fs::exists(common, error)) return common;
  throw Failure(Exit::outside,
                fmt::format("no configuration for {}: there is no {} and no {}; name one with "
                            "--config FILE",
                            program.string(), by_stem.string(), common.string()));
}

}  // namespace robosync::tool
