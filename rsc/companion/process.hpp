// A module's program, started with its stdout and stderr on pipes. Whatever it writes or does, the caller never waits for it
// and its memory use stays bounded.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace robosync::tool {

class WorkerProcess {
public:
  // A `program` that cannot be run ends with 127.
  WorkerProcess(const std::string& program, const std::vector<std::string>& arguments);
  // Ends it and the processes that it started.
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  // The complete lines of stdout so far, without newlines: a few kilobytes at most, the rest on the next call. Lines that are
  // too long are cut.
  [[nodiscard]] std::vector<std::string> lines();
  // Its status from waitpid(); nothing: it is running.
  [[nodiscard]] std::optional<int> ended();
  // The last line of its stderr, printable.
  [[nodiscard]] const std::string& last_words();

private:
  void read_errors();

  pid_t child_ = -1;
  int out_ = -1, err_ = -1;
  std::optional<int> status_;
  std::string line_, error_line_, last_words_;
};

// "exit 3", "signal 11 (Segmentation fault)".
[[nodiscard]] std::string how_it_ended(int status);

// `text` made safe for a terminal: anything but printable ASCII becomes `?`.
[[nodiscard]] std::string printable(const std::string& text);

}  // namespace robosync::tool
