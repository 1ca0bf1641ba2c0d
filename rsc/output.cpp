// May assume POSIX. Promises that an existing file is never left half written.
#include "rsc/output.hpp"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <optional>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "rsc/failure.hpp"

namespace robosync::tool {
namespace fs = std::filesystem;
namespace {

constexpr mode_t kPermissions = 0777;
constexpr mode_t kNewFile = 0666;

[[noreturn]] void fail(const fs::path& path, int error) {
  throw Failure(Exit::outside,
                fmt::format("cannot write {}: {}", path.string(), std::strerror(error)));
}

std::optional<struct stat> facts_of(const fs::path& path) {
  struct stat facts {};
  if (stat(path.c_str(), &facts) != 0) return std::nullopt;
  return facts;
}

bool same_file(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

void write_all(int file, std::span<const std::byte> bytes, const fs::path& path) {
  while (!bytes.empty()) {
    const ssize_t count = write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, errno);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

// An open file, closed at the end.
class File {
public:
  explicit File(int number) : number_(number) {}
  ~File() {
    if (number_ >= 0) close(number_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int number() const { return number_; }

private:
  int number_;
};

// Opens a new file; -1 if that fails. `name` becomes its name: `target` with a suffix that no other thread or process uses. A
// killed process may have left such a file, and its process number may be in use again.
int create_beside(const fs::path& target, mode_t mode, std::string& name) {
  static std::atomic<unsigned> count = 0;
  constexpr int kAttempts = 100;
  int file = -1;
  for (int i = 0; i < kAttempts; ++i) {
    name = fmt::format("{}.{}-{}", target.string(), getpid(), ++count);
    file = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (file >= 0 || errno != EEXIST) break;
  }
  return file;
}

// A temporary file next to the target. Removed unless it was renamed.
class Temporary {
public:
  // `mode`, subject to the umask, as for every new file.
  Temporary(const fs::path& target, mode_t mode)
      : target_(target), file_(create_beside(target, mode, name_)) {
    if (file_.number() < 0) fail(target_, errno);
  }
  ~Temporary() {
    if (file_.number() >= 0 && !renamed_) unlink(name_.c_str());
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  void write(std::span<const std::byte> bytes) const { write_all(file_.number(), bytes, target_); }

  // Regardless of the umask.
  void set_mode(mode_t mode) const {
    if (fchmod(file_.number(), mode) != 0) fail(target_, errno);
  }
  void replace_target() {
    if (fsync(file_.number()) != 0 || std::rename(name_.c_str(), target_.c_str()) != 0) {
      fail(target_, errno);
    }
    renamed_ = true;
  }

private:
  fs::path target_;
  std::string name_;
  File file_;
  bool renamed_ = false;
};

// /dev/stdout and the like are system links that may lead to an ordinary file.
bool is_link_of_system(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return false;
  const fs::path folder = fs::weakly_canonical(fs::absolute(path, error).parent_path(), error);
  const auto top = std::next(folder.begin());
  return top != folder.end() && (*top == "dev" || *top == "proc");
}

// Not an ordinary file, or reached through a link that must stay.
bool is_written_through(const fs::path& path, const std::optional<struct stat>& facts) {
  std::error_code error;
  if (!facts) return fs::is_symlink(path, error);
  return !S_ISREG(facts->st_mode) || is_link_of_system(path);
}

void write_through(const fs::path& path, std::span<const std::byte> bytes) {
  std::cout.flush();
  if (is_stdout(path)) {  // reopening an ordinary file would overwrite it from the start
    write_all(STDOUT_FILENO, bytes, path);
    return;
  }
  write_in_place(path, bytes);
}

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
  throw Failure(Exit::usage,
                fmt::format("{} {}; nothing was written: name another file", path.string(), why));
}

// Otherwise all programs next to it would fail for no visible reason.
void refuse_name_of_configuration(const fs::path& path) {
  std::error_code error;
  constexpr const char* kWhy = "would be taken for the configuration of {}, because of its name";
  if (path.extension() != ".json") return;
  if (path.filename() == "robot.json") refuse(path, fmt::format(kWhy, "the programs beside it"));
  fs::path program = path;
  program.replace_extension(".rsl");
  if (fs::exists(program, error)) refuse(path, fmt::format(kWhy, program.string()));
}

// What rsc makes again at any time may be overwritten.
bool matters(FileKind kind) {
  return kind != FileKind::other && kind != FileKind::trace && kind != FileKind::perfetto;
}

// Works for paths that do not exist yet.
fs::path whole_name(const fs::path& path) {
  std::error_code error;
  return fs::weakly_canonical(fs::absolute(path, error), error);
}

}  // namespace

void check_outputs(std::initializer_list<Output> outputs, const std::vector<std::string>& inputs) {
  for (const Output& output : outputs) {
    if (output.path.empty()) continue;
    check_output(output, inputs);
    for (const Output* other = outputs.begin(); other != &output; ++other)
      if (!other->path.empty() && whole_name(other->path) == whole_name(output.path) &&
          !is_written_through(output.path, facts_of(output.path)))
        refuse(output.path, "is given for two outputs");
  }
}

void check_output(const Output& output, const std::vector<std::string>& inputs) {
  const fs::path path = output.path;
  const auto facts = facts_of(path);
  if (facts && S_ISDIR(facts->st_mode)) fail(path, EISDIR);
  if (facts && !S_ISREG(facts->st_mode)) return;
  if (path == "-") refuse(path, "is not an output, /dev/stdout is");
  if (!facts) {
    refuse_name_of_configuration(path);
    return;
  }
  for (const std::string& input : inputs) {
    const auto other = facts_of(input);
    if (!other || !same_file(*facts, *other)) continue;
    throw Failure(Exit::usage,
                  path == fs::path(input)
                      ? fmt::format("{} is an input; nothing was written", input)
                      : fmt::format("{} is the same file as {}, which is an input; nothing was "
                                    "written",
                                    path.string(), input));
  }
  refuse_name_of_configuration(path);
  if (const FileKind kind = kind_of_file(path); matters(kind) && kind != output.again)
    refuse(path, fmt::format("already exists, and is {}", describe(kind)));
}

bool is_stdout(const fs::path& path) {
  const auto facts = facts_of(path);
  struct stat out {};
  if (!facts || fstat(STDOUT_FILENO, &out) != 0 || !same_file(*facts, out)) return false;
  return !S_ISCHR(out.st_mode) || isatty(STDOUT_FILENO) == 1;  // not /dev/null
}

// fsync() fails on pipes and terminals, which need none.
void write_in_place(const fs::path& path, std::span<const std::byte> bytes) {
  const File file(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kNewFile));
  if (file.number() < 0) fail(path, errno);
  write_all(file.number(), bytes, path);
  if (fsync(file.number()) != 0 && errno != EINVAL && errno != EROFS) fail(path, errno);
}

void write_output(const fs::path& path, std::span<const std::byte> bytes) {
  const auto facts = facts_of(path);
  if (is_written_through(path, facts)) {
    write_through(path, bytes);
    return;
  }
  if (facts && access(path.c_str(), W_OK) != 0) fail(path, errno);
  const mode_t mode = facts ? facts->st_mode & kPermissions : kNewFile;
  Temporary file(path, mode);
  file.write(bytes);
  if (facts) file.set_mode(mode);
  file.replace_target();
}

void write_edited(const fs::path& path, std::span<const std::byte> bytes) {
  std::error_code error;
  const fs::path file = fs::canonical(path, error);
  write_output(error ? path : file, bytes);
}

}  // namespace robosync::tool
