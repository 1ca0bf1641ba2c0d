// Runs the built rsc as a user would, and files for it in a folder of its own.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace robosync::test {

struct Outcome {
  int exit = -1;
  std::string out, err;
};

// `environment`: additions, as NAME=VALUE. Ends after 60 s with exit -1.
[[nodiscard]] Outcome rsc(std::vector<std::string> arguments,
                          const std::vector<std::string>& environment = {});

// A folder that goes away with the object.
class Folder {
public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  // Path of a file in it, as a string for the command line.
  std::string path(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;
  bool has(const std::string& name) const { return std::filesystem::exists(path_ / name); }
  std::size_t files() const;

private:
  std::filesystem::path path_;
};

// The built rsc while it runs. What it prints lies in a folder of its own.
class Running {
public:
  explicit Running(std::vector<std::string> arguments);
  ~Running();  // kills it, if it still runs
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  // Waits until it has printed `text` on stderr `times` times; false when it has ended before that, or after 60 s.
  [[nodiscard]] bool has_said(const std::string& text, std::size_t times);
  std::string out() const { return folder_.read("out"); }
  std::string err() const { return folder_.read("err"); }
  // Sends `signal`, and waits for the end.
  [[nodiscard]] Outcome end(int signal);

private:
  Folder folder_;
  int process_ = 0;  // 0: it has ended
};

}  // namespace robosync::test
