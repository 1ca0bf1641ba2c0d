// The programs in the documentation are what they say they are: rsc finds nothing wrong with them,
// the robot takes them and runs, and their TESTs pass.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "companion/words_file.hpp"
#include "tests/docs/pages.hpp"
#include "tests/support/golden.hpp"

namespace {

using robosync::test::check_program;
using robosync::test::check_runs;
using robosync::test::Folder;
using robosync::test::Outcome;
using robosync::test::rsc;
using robosync::testing::read_file;

const std::filesystem::path kRoot = ROBOSYNC_SOURCE_DIR;

// The fenced blocks of `language` in a Markdown file.
std::vector<std::string> blocks(const std::filesystem::path& path, const std::string& language) {
  return robosync::test::blocks_in(read_file(path), language);
}

// What a page says that a command prints, below its comment <!-- printed: COMMAND -->.
// ROBOSYNC_UPDATE_GOLDEN=1 rewrites it.
void check_printed(const std::filesystem::path& path, const std::string& command,
                   const std::string& printed) {
  std::string page = read_file(path);
  const std::string opening = "<!-- printed: " + command + " -->\n```\n";
  const std::size_t at = page.find(opening);
  REQUIRE(at != std::string::npos);
  const std::size_t begin = at + opening.size();
  const std::size_t length = page.find("```", begin) - begin;
  if (robosync::testing::updating_golden())
    std::ofstream(path, std::ios::binary) << page.replace(begin, length, printed);
  else
    CHECK(page.substr(begin, length) == printed);
}

// The quoted beginnings of the first table's rows; what is left out behind "…" is not there.
std::vector<std::string> quoted_rows(const std::string& text) {
  std::vector<std::string> rows;
  const std::string opening = "\n| `";
  const std::size_t end = text.find("\n\n", text.find(opening));
  for (auto at = text.find(opening); at < end; at = text.find(opening, at)) {
    at += opening.size();
    const std::string row = text.substr(at, text.find('`', at) - at);
    rows.push_back(row.substr(0, row.find("…")));
  }
  return rows;
}

void check_page(const char* page, const std::string& robot, std::size_t at_least) {
  const auto programs = blocks(kRoot / page, "rsl");
  CHECK(programs.size() >= at_least);
  for (const std::string& program : programs)
    check_program(program, robot);
}

}  // namespace

TEST_CASE("every program in docs/language.md works on docs/robot.json") {
  check_page("docs/language.md", read_file(kRoot / "docs/robot.json"), 36);
}

TEST_CASE("every program in docs/tutorial.md works on the robot.json it begins with") {
  const auto files = blocks(kRoot / "docs/tutorial.md", "json");
  REQUIRE(files.size() == 4);  // robot.json, visit.json, visitors.json, touches.json
  check_page("docs/tutorial.md", files.front(), 10);
}

TEST_CASE("every program in the documentation is in the standard style") {
  const Folder folder;
  std::size_t programs = 0;
  for (const auto& page : std::filesystem::directory_iterator(kRoot / "docs")) {
    if (page.path().extension() != ".md") continue;
    for (const std::string& program : blocks(page.path(), "rsl")) {
      INFO(page.path() << '\n' << program);
      ++programs;
      check_runs(rsc({"fmt", "--check", folder.write("robot.rsl", program)}));
    }
  }
  CHECK(programs > 100);
}

TEST_CASE("the scenarios of docs/tutorial.md do what it says") {
  const auto files = blocks(kRoot / "docs/tutorial.md", "json");
  REQUIRE(files.size() == 4);
  const auto programs = blocks(kRoot / "docs/tutorial.md", "rsl");
  REQUIRE(programs.size() == 10);
  const Folder folder;
  folder.write("robot.json", files[0]);
  const auto run = [&](std::size_t program, std::size_t scenario) {
    const Outcome outcome = rsc({"run", folder.write("robot.rsl", programs[program]), "--scenario",
                                 folder.write("scenario.json", files[scenario])});
    check_runs(outcome);
    return outcome.out;
  };
  CHECK_THAT(run(0, 1), Catch::Contains("SAY Hello!"));
  CHECK_THAT(run(7, 1), Catch::Contains("SAY You are visitor 1."));
  CHECK_THAT(run(7, 1), Catch::Contains("SAY You are visitor 2."));  // KEPT
  CHECK_THAT(run(8, 3), Catch::Contains("6.501 s  joy becomes 80%"));
  const std::string shown = run(4, 2);
  check_printed(kRoot / "docs/tutorial.md", "rsc run robot.rsl --scenario visitors.json", shown);
  const std::string page = read_file(kRoot / "docs/tutorial.md");
  const auto explained = quoted_rows(page.substr(page.find("Line by line, from the top:")));
  CHECK(explained.size() == 6);
  for (const std::string& line : explained)
    CHECK_THAT(shown, Catch::Contains(line));
}

TEST_CASE("the scenarios and the recording of docs/scenario.md are played") {
  const auto scenarios = blocks(kRoot / "docs/scenario.md", "json");
  const auto recordings = blocks(kRoot / "docs/scenario.md", "csv");
  REQUIRE(scenarios.size() == 2);
  REQUIRE(recordings.size() == 1);
  const Folder folder;
  folder.write("robot.json", read_file(kRoot / "docs/robot.json"));
  folder.write("visit.csv", recordings[0]);
  const std::string program =
      folder.write("robot.rsl",
                   "WHEN touch LEVEL CHANGES\nDO LOG \"touch\", touch LEVEL\nEND\n"
                   "WHEN proximity DISTANCE < 1190mm\nMARGIN 5mm\nDO SHOW face happy\nEND\n");
  const auto run = [&](std::size_t scenario) {
    const Outcome outcome =
        rsc({"run", program, "--scenario", folder.write("scenario.json", scenarios[scenario])});
    check_runs(outcome);
    return outcome;
  };
  const Outcome first = run(0);
  CHECK_THAT(first.out, Catch::Contains("1.000 s") && Catch::Contains("touch 5"));
  CHECK_THAT(first.err,
             Catch::Contains("scenario.json:8: note: the program does not read voice WORD"));
  const Outcome second = run(1);
  CHECK_THAT(second.out, Catch::Contains("0.050 s  face SHOW happy") && Catch::Contains("0.100 s"));
  CHECK_THAT(second.err, !Catch::Contains("note: the program does not read"));
}

TEST_CASE("every program in docs/stdlib.md works on stdlib/robot.json") {
  check_page("docs/stdlib.md", read_file(kRoot / "stdlib/robot.json"), 8);
}

TEST_CASE("the robot.json in docs/configuration.md works") {
  const auto configurations = blocks(kRoot / "docs/configuration.md", "json");
  REQUIRE(configurations.size() == 1);
  check_program("WHEN touch LEVEL > 4\nDO MOVE arms QUICKLY\nEND\n", configurations.front());
}

TEST_CASE("the robot that is taught words in docs/algorithms.md works") {
  const auto page = kRoot / "docs/algorithms.md";
  const auto programs = blocks(page, "rsl");
  REQUIRE(programs.size() == 1);
  const auto robots = blocks(page, "json");
  const auto robot = std::ranges::find_if(
      robots, [](const std::string& text) { return text.find("own_words") != std::string::npos; });
  REQUIRE(robot != robots.end());
  const Folder folder;
  folder.write("robot.json", *robot);
  const robosync::companion::Sample sample(8, own_words_frame{});
  folder.write("my.words",
               robosync::companion::write_words({{"merhaba", {sample}, 0}, {"dur", {sample}, 0}}));
  const std::string file = folder.write(
      "robot.rsl", programs.front() +
                       "TEST \"it hears\"\n  AT 0s voice WORD = \"none\"\n  AT 1s voice WORD = "
                       "\"merhaba\"\n  EXPECT SAY \"Merhaba\" WITHIN 20ms\nEND\n");
  check_runs(rsc({"check", file}));
  check_runs(rsc({"test", file}));
}
