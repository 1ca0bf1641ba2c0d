// Detects that one of several edited files has been saved.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rsc/program.hpp"

namespace robosync::tool {

// All files of a program that can be read, with its modules and its configuration.
[[nodiscard]] std::vector<std::string> files_of_program(const std::string& file,
                                                        const CompileOptions& how);

class SavedFiles {
public:
  // Watches these files from now on. A file that does not exist yet counts as saved when it appears.
  void look_at(const std::vector<std::string>& files);
  // True if a file was saved since the last call or look_at(). Call it often: it reports a change once nothing has changed
  // for a moment, since an editor may write a file in pieces.
  [[nodiscard]] bool changed();

private:
  struct Facts {
    std::filesystem::file_time_type time;
    std::uintmax_t bytes = 0;
    bool operator==(const Facts&) const = default;
  };
  static Facts facts_of(const std::string& file);

  std::map<std::string, Facts> files_;
  std::optional<std::chrono::steady_clock::time_point>
      changed_;  // when a file last changed; nothing: reported
};

}  // namespace robosync::tool
