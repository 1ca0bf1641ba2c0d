// Compares a text with a golden file; with ROBOSYNC_UPDATE_GOLDEN=1 in the environment, rewrites
// it.
#pragma once

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace robosync::vm::test {

inline bool update_golden() {
  const char* const update = std::getenv("ROBOSYNC_UPDATE_GOLDEN");
  return update != nullptr && std::string(update) == "1";
}

// `path` from the top of the repository.
inline std::string read_text(const std::string& path) {
  std::ifstream file(ROBOSYNC_SOURCE_DIR "/" + path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
inline void write_text(const std::string& path, const std::string& text) {
  std::ofstream(ROBOSYNC_SOURCE_DIR "/" + path, std::ios::binary) << text;
}

// What the golden file says; after rewriting it, when asked to.
inline std::string golden(const std::string& path, const std::string& actual) {
  if (update_golden()) write_text(path, actual);
  return read_text(path);
}

}  // namespace robosync::vm::test
