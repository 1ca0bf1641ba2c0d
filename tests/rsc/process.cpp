// Without a shell: posix_spawn, and files for what it prints.
#include "tests/rsc/process.hpp"

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace robosync::test {
namespace {

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> list;
  for (std::string& text : strings)
    list.push_back(text.data());
  list.push_back(nullptr);
  return list;
}

int wait_for(pid_t process) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  int status = 0;
  while (waitpid(process, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > give_up) {
      kill(process, SIGKILL);
      waitpid(process, &status, 0);
      return -1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  constexpr int kBySignal = 128;  // as a shell says it
  return WIFEXITED(status) ? WEXITSTATUS(status) : kBySignal + WTERMSIG(status);
}

// It prints into `out` and `err` of the folder.
pid_t start(std::vector<std::string> arguments, const std::vector<std::string>& environment,
            const Folder& folder) {
  arguments.insert(arguments.begin(), "rsc");
  std::vector<std::string> variables = environment;
  for (char** variable = environ; *variable != nullptr; ++variable)
    variables.emplace_back(*variable);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  const std::string out = folder.path("out");
  const std::string err = folder.path("err");
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT, 0600);
  pid_t process = 0;
  const int error = posix_spawn(&process, RSC_BINARY, &actions, nullptr, pointers(arguments).data(),
                                pointers(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error("cannot start " RSC_BINARY);
  return process;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

}  // namespace

Outcome rsc(std::vector<std::string> arguments, const std::vector<std::string>& environment) {
  const Folder folder;
  const int exit = wait_for(start(std::move(arguments), environment, folder));
  return {exit, folder.read("out"), folder.read("err")};
}

Running::Running(std::vector<std::string> arguments)
    : process_(start(std::move(arguments), {}, folder_)) {}

Running::~Running() {
  if (process_ == 0) return;
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

bool Running::has_said(const std::string& text, std::size_t times) {
  return await([this] { return err(); }, text, times);
}

bool Running::has_written(const std::string& file, const std::string& text, std::size_t times) {
  return await([&] { return testing::read_file(file); }, text, times);
}

template <typename Read>
bool Running::await(const Read& read, const std::string& text, std::size_t times) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (count_of(read(), text) < times) {
    const bool ended = process_ == 0 || waitpid(process_, nullptr, WNOHANG) != 0;
    if (ended) process_ = 0;
    if (ended || std::chrono::steady_clock::now() > give_up) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

void Running::send(int signal) const {
  kill(process_, signal);
}

Outcome Running::end(int signal) {
  int exit = -1;
  if (process_ != 0 && kill(process_, signal) == 0) exit = wait_for(std::exchange(process_, 0));
  return {exit, out(), err()};
}

}  // namespace robosync::test
