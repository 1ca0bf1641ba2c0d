// Files that somebody edits: has one been saved?
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

// All that a program is made of, as far as it can be read: its modules and its
// configuration, too.
[[nodiscard]] std::vector<std::string> files_of_program(const std::string& file,
                                                        const CompileOptions& how);

class SavedFiles {
public:
  // From here on these are looked at. A file that is not there yet counts as
  // saved when it comes.
  void look_at(const std::vector<std::string>& files);
  // Since it was asked last, or look_at(). Ask often: it is said once nothing has changed for a moment, since an editor may
  // write a file in pieces.
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
      changed_;  // the last time; nothing: it is said
};

}  // namespace robosync::tool
