// Programs that tests/generators/programs has drawn, and the robot that they are for. Some are larger
// than a robot may be.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/golden.hpp"

namespace robosync::testing {

inline std::vector<std::string> drawn_programs() {
  const std::string all = read_file(ROBOSYNC_DRAWN_PROGRAMS);
  std::vector<std::string> programs;
  const std::string end = "\f\n";
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t stop = all.find(end, at);
    programs.push_back(all.substr(at, stop - at));
    at = stop + end.size();
  }
  return programs;
}

inline std::string drawn_robot() {
  const std::filesystem::path top = ROBOSYNC_SOURCE_DIR;
  return read_file(top / "tests/generators/programs/robot.json");
}

}  // namespace robosync::testing
