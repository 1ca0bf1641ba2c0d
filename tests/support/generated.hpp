// Parts of the documentation that are made of the lists of the source: they stand between two markers,
// <!-- generated: PART --> and <!-- end of PART -->. ROBOSYNC_UPDATE_GOLDEN=1 rewrites them (scripts/test --update).
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/golden.hpp"

namespace robosync::testing {

// Checks that the page at `path` says exactly `wanted` there.
inline void expect_generated(const std::filesystem::path& path, const std::string& part,
                             const std::string& wanted) {
  const std::string begin = "<!-- generated: " + part + " -->\n";
  const std::string end = "<!-- end of " + part + " -->\n";
  INFO(path << " has a part between " << begin << " and " << end
            << "ROBOSYNC_UPDATE_GOLDEN=1 rewrites it");
  std::string page = read_file(path);
  const std::size_t start = page.find(begin);
  const std::size_t stop = page.find(end);
  REQUIRE(start != std::string::npos);
  REQUIRE(stop != std::string::npos);
  const std::size_t first = start + begin.size();
  REQUIRE(first <= stop);
  if (updating_golden())
    std::ofstream(path, std::ios::binary) << page.replace(first, stop - first, wanted);
  else
    CHECK(page.substr(first, stop - first) == wanted);
}

}  // namespace robosync::testing
