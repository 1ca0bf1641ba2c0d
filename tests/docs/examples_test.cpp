// The examples and the standard library, as their readers would try them: rsc check, test, run.
#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/rsc/process.hpp"
#include "tests/support/golden.hpp"

namespace {

namespace fs = std::filesystem;
using robosync::test::Outcome;
using robosync::test::rsc;
using robosync::testing::read_file;

const fs::path kExamplesRoot = ROBOSYNC_SOURCE_DIR;

std::vector<fs::path> files(const fs::path& folder, const std::string& extension) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == extension) found.push_back(entry.path());
  std::ranges::sort(found);
  return found;
}

std::vector<fs::path> examples() {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(kExamplesRoot / "examples"))
    if (fs::exists(entry.path() / "robot.rsl")) found.push_back(entry.path());
  std::ranges::sort(found);
  return found;
}

bool has_tests(const fs::path& program) {
  return read_file(program).find("\nTEST \"") != std::string::npos;
}

void works(const std::vector<std::string>& arguments) {
  const Outcome outcome = rsc(arguments);
  INFO(outcome.out);
  INFO(outcome.err);
  CHECK(outcome.exit == 0);
}

}  // namespace

TEST_CASE("every example is right, passes its TESTs and lives through its scenarios") {
  const auto folders = examples();
  CHECK(folders.size() >= 10);
  for (const fs::path& folder : folders) {
    const std::string program = folder / "robot.rsl";
    INFO(program);
    works({"check", program});
    works({"explain", program});
    if (has_tests(program)) works({"test", program});
    for (const fs::path& scenario : files(folder, ".json"))
      if (scenario.filename() != "robot.json") works({"run", program, "--scenario", scenario});
  }
}

TEST_CASE("an example is a page: 60 lines at most, without its TESTs and empty lines") {
  for (const fs::path& folder : examples()) {
    INFO(folder);
    std::istringstream program(read_file(folder / "robot.rsl"));
    unsigned lines = 0;
    bool in_test = false;
    for (std::string line; std::getline(program, line);) {
      in_test = in_test || line.starts_with("TEST \"");
      if (!in_test && !line.empty()) ++lines;
      if (line == "END") in_test = false;
    }
    CHECK(lines <= 60);
  }
}

TEST_CASE("every module of the standard library passes its TESTs") {
  const std::string robot = kExamplesRoot / "stdlib/robot.json";
  const auto modules = files(kExamplesRoot / "stdlib", ".rsl");
  CHECK(modules.size() >= 8);
  for (const fs::path& module : modules) {
    INFO(module);
    works({"check", module});
    const fs::path around = kExamplesRoot / "stdlib/tests" / module.filename();
    CHECK((has_tests(module) || fs::exists(around)));
    if (has_tests(module)) works({"test", module});
    if (fs::exists(around)) works({"test", around, "--config", robot});
  }
}

TEST_CASE("every module of the standard library is used by an example") {
  std::string programs;
  for (const fs::path& folder : examples())
    programs += read_file(folder / "robot.rsl");
  for (const fs::path& module : files(kExamplesRoot / "stdlib", ".rsl"))
    CHECK_THAT(programs, Catch::Contains("\nUSE " + module.stem().string() + "\n"));
}
