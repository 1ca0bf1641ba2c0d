// The modules in files that this process has loaded, by the number under which algorithms::find_module() knows them. Each runs in a
// process of its own (process.hpp); one that is in trouble has failed for whoever calls it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "runtime-m4/algorithms/robosync_module.h"

namespace robosync::module_files {

// How many there can be at a time.
inline constexpr std::size_t kMostFiles = 16;

struct Loaded {
  const robosync_description* description = nullptr;  // until the file is loaded again
  std::size_t number = 0;
  std::string why_not;  // where there is no description
};

// Loads a file, or finds it loaded, if it is as it was.
[[nodiscard]] Loaded load(const std::string& path);

// What has happened to modules since they were loaded: "FILE: it …".
[[nodiscard]] std::vector<std::string> troubles();

}  // namespace robosync::module_files
