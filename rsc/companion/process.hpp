// The program of a module, started with its stdout and stderr on pipes. It may say and do what it likes: nothing that it does
// makes whoever started it wait, or need more memory.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace robosync::tool {

class WorkerProcess {
public:
  // `program` that cannot be run is one that ends with 127.
  WorkerProcess(const std::string& program, const std::vector<std::string>& arguments);
  // Ends it, and what it has started in its turn.
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  // The whole lines of stdout that have come, without their ends: some kilobytes at most, the rest the next time. What is
  // longer than a line may be is cut.
  [[nodiscard]] std::vector<std::string> lines();
  // How it ended, as waitpid() says; nothing: it runs.
  [[nodiscard]] std::optional<int> ended();
  // The last line of its stderr, in characters that a terminal shows.
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

// `text` as a terminal may show it: what is no printable ASCII becomes `?`.
[[nodiscard]] std::string printable(const std::string& text);

}  // namespace robosync::tool
