// Runs the built rsc as a user would.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/folder.hpp"

namespace robosync::test {

struct Outcome {
  int exit = -1;
  std::string out, err;
};

// `environment`: additions, as NAME=VALUE. Ends after 60 s with exit -1.
[[nodiscard]] Outcome rsc(std::vector<std::string> arguments,
                          const std::vector<std::string>& environment = {});

// The built rsc while it runs. What it prints lies in a folder of its own.
class Running {
public:
  explicit Running(std::vector<std::string> arguments);
  ~Running();  // kills it, if it still runs
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  // Waits until it has printed `text` on stderr `times` times; false when it has ended before that, or after 60 s.
  [[nodiscard]] bool has_said(const std::string& text, std::size_t times);
  // The same for what it writes to a file.
  [[nodiscard]] bool has_written(const std::string& file, const std::string& text,
                                 std::size_t times);
  std::string out() const { return folder_.read("out"); }
  std::string err() const { return folder_.read("err"); }
  void send(int signal) const;
  // Sends `signal`, and waits for the end.
  [[nodiscard]] Outcome end(int signal);

private:
  template <typename Read>
  bool await(const Read& read, const std::string& text, std::size_t times);

  Folder folder_;
  int process_ = 0;  // 0: it has ended
};

}  // namespace robosync::test
