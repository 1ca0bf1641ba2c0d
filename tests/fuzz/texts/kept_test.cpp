// Every input that is kept, through its target: what libFuzzer has found once stays mended. kept/NAME/ are those of the
// target NAME; what the examples have of its kind is run, too.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/fuzz/texts/targets.hpp"

namespace robosync::fuzz {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = ROBOSYNC_SOURCE_DIR;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Returns how many there were.
unsigned run_all(const fs::path& folder, std::string_view ending,
                 void (*target)(std::string_view)) {
  unsigned count = 0;
  if (!fs::exists(folder)) return 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_regular_file() || !name.ends_with(ending)) continue;
    INFO(entry.path());
    target(text_of(entry.path()));
    ++count;
  }
  return count;
}

}  // namespace

TEST_CASE("what the fuzzers have found once is found no more") {
  unsigned count = 0;
#define TARGET(name, what) count += run_all(kSource / "tests/fuzz/texts/kept" / #name, "", name);
#include "tests/fuzz/texts/targets.def"
#undef TARGET
  CHECK(count > 0);
}

TEST_CASE("the examples go through the fuzzers' targets") {
  CHECK(run_all(kSource / "examples", ".rsl", rsl) > 0);
  CHECK(run_all(kSource / "examples", "robot.json", robot) > 0);
  CHECK(run_all(kSource / "examples", ".json", scenario) > 0);
}

}  // namespace robosync::fuzz
