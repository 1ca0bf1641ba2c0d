// The modules in files that this process has loaded, by the number under which algorithms::find_module() finds them. Each runs in
// its own process (process.hpp). A module in trouble fails for its callers.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "runtime-m4/algorithms/robosync_module.h"

namespace robosync::module_files {

// The most modules at a time.
inline constexpr std::size_t kMostFiles = 16;

struct Loaded {
  const robosync_description* description = nullptr;  // until the file is loaded again
  std::size_t number = 0;
  std::string why_not;  // if there is no description
};

// Loads a file, or finds the loaded module if the file has not changed.
[[nodiscard]] Loaded load(const std::string& path);

// What has happened to modules since they were loaded: "FILE: it …".
[[nodiscard]] std::vector<std::string> troubles();

}  // namespace robosync::module_files
