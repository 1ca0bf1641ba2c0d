// See process.hpp. Linux.
#include "rsc/companion/process.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace robosync::tool {
namespace {

constexpr std::size_t kMostBytes = 4096;  // per call
constexpr std::size_t kLongestLine = 200;
constexpr int kNotThere = 127;

[[noreturn]] void become(const std::string& program, const std::vector<std::string>& arguments,
                         int out, int err) {
  setpgid(0, 0);  // so that its children can be ended with it
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  closefrom(STDERR_FILENO + 1);  // among them the line to the robot
  std::vector<char*> texts = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments)
    texts.push_back(const_cast<char*>(argument.c_str()));
  texts.push_back(nullptr);
  execv(program.c_str(), texts.data());
  const std::string why = fmt::format("{}: {}\n", program, std::strerror(errno));
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, why.data(), why.size());
  _exit(kNotThere);
}

// Reads what is available without waiting.
std::string read_some(int file) {
  std::array<char, kMostBytes> bytes{};
  const ssize_t count = file < 0 ? 0 : read(file, bytes.data(), bytes.size());
  return {bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0))};
}

// Appends `text` to `rest`, and returns the complete lines.
std::vector<std::string> split(const std::string& text, std::string& rest) {
  std::vector<std::string> lines;
  for (const char c : text)
    if (c == '\n')
      lines.push_back(std::exchange(rest, {}));
    else if (rest.size() < kLongestLine)
      rest += c;
  return lines;
}

}  // namespace

WorkerProcess::WorkerProcess(const std::string& program,
                             const std::vector<std::string>& arguments) {
  std::array<int, 2> out{-1, -1}, err{-1, -1};
  const bool has_pipes = pipe2(out.data(), O_CLOEXEC) == 0 && pipe2(err.data(), O_CLOEXEC) == 0;
  if (has_pipes) child_ = fork();
  if (child_ == 0) become(program, arguments, out[1], err[1]);
  for (const int file : {out[1], err[1]})
    if (file >= 0) close(file);
  out_ = out[0];
  err_ = err[0];
  for (const int file : {out_, err_})
    if (file >= 0) fcntl(file, F_SETFL, O_NONBLOCK);
  if (child_ < 0) {
    last_words_ = "this computer cannot start any more programs";
    status_ = kNotThere << 8;
  }
}

// A driver may block it: then it is left to the system.
WorkerProcess::~WorkerProcess() {
  constexpr int kTries = 200;
  constexpr std::chrono::milliseconds kBetween{5};
  if (child_ > 0) {
    kill(-child_, SIGKILL);
    kill(child_, SIGKILL);  // it may not have called setpgid() yet
    for (int i = 0; i < kTries && !ended(); ++i)
      std::this_thread::sleep_for(kBetween);
  }
  for (const int file : {out_, err_})
    if (file >= 0) close(file);
}

std::vector<std::string> WorkerProcess::lines() {
  read_errors();
  return split(read_some(out_), line_);
}

void WorkerProcess::read_errors() {
  for (std::string& line : split(read_some(err_), error_line_))
    if (!line.empty()) last_words_ = printable(line);
}

const std::string& WorkerProcess::last_words() {
  read_errors();
  return last_words_;
}

std::optional<int> WorkerProcess::ended() {
  int status = 0;
  if (!status_ && waitpid(child_, &status, WNOHANG) == child_) status_ = status;
  return status_;
}

std::string how_it_ended(int status) {
  if (WIFSIGNALED(status))
    return fmt::format("signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  return fmt::format("exit {}", WEXITSTATUS(status));
}

std::string printable(const std::string& text) {
  std::string result = text;
  std::ranges::replace_if(
      result, [](char c) { return c < ' ' || c > '~'; }, '?');
  return result;
}

}  // namespace robosync::tool
