// Golden files: expected text kept in the repository. ROBOSYNC_UPDATE_GOLDEN=1 rewrites them
// (scripts/test --update); the difference then shows in version control, where a person judges it.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <catch2/catch.hpp>

#include "tests/support/read_file.hpp"

namespace robosync::testing {

inline bool updating_golden() {
  const char* value = std::getenv("ROBOSYNC_UPDATE_GOLDEN");
  return value != nullptr && std::string(value) == "1";
}

// Checks that the file at `path` holds exactly `actual`. A missing file is a failure, too.
inline void expect_golden(const std::filesystem::path& path, const std::string& actual) {
  if (updating_golden()) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << actual;
  }
  INFO("golden file " << path << "; ROBOSYNC_UPDATE_GOLDEN=1 rewrites it");
  CHECK(std::filesystem::exists(path));
  CHECK(read_file(path) == actual);
}

}  // namespace robosync::testing
