// rsc new: what it makes works as it stands, and nothing that is there is touched.
#include <cstdlib>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "compiler/config/boards.hpp"
#include "rsc/templates.hpp"
#include "tests/rsc/process.hpp"

using namespace robosync;
using Catch::Contains;
using nlohmann::json;
using test::Folder;
using test::Outcome;

TEST_CASE("each template checks without a warning, runs its scenario, and passes its tests") {
  for (const tool::Template& robot : tool::templates()) {
    INFO(robot.name);
    const Folder folder;
    const std::string place = folder.path("a/my_robot");
    const Outcome made = test::rsc({"new", place, "--template", std::string(robot.name)});
    INFO(made.err);
    REQUIRE(made.exit == 0);
    CHECK_THAT(made.out, Contains(std::string(robot.scenario)));
    const std::string program = place + "/robot.rsl";
    const Outcome checked = test::rsc({"check", program, "--format", "json"});
    CHECK(checked.exit == 0);
    CHECK(json::parse(checked.out).at("warnings") == 0);
    const Outcome ran =
        test::rsc({"run", program, "--scenario", place + "/" + std::string(robot.scenario)});
    CHECK(ran.exit == 0);
    CHECK(test::rsc({"test", program}).exit == 0);
    CHECK(folder.read("a/my_robot/robot.json").find("$schema") == std::string::npos);
  }
}

TEST_CASE("without a template it is the first one") {
  const Folder folder;
  CHECK(test::rsc({"new", folder.path("one")}).exit == 0);
  CHECK(test::rsc({"new", folder.path("two"), "--template", "companion"}).exit == 0);
  CHECK(folder.read("one/robot.rsl") == folder.read("two/robot.rsl"));
}

namespace {

// Is what `rsc new` made there right, and for this board?
void check_made(const Folder& folder, const std::string& place, std::string_view board) {
  const std::string program = folder.path(place + "/robot.rsl");
  const Outcome checked = test::rsc({"check", program, "--format", "json"});
  CAPTURE(checked.out);
  CHECK(checked.exit == 0);
  CHECK(json::parse(checked.out).at("warnings") == 0);
  CHECK(test::rsc({"test", program}).exit == 0);
  CHECK(json::parse(folder.read(place + "/robot.json")).at("board") == board);
}

}  // namespace

TEST_CASE("with a board, each template fits it, or is refused with those that do") {
  std::size_t refused = 0;
  for (const std::string_view board : compiler::board_names()) {
    const Folder folder;
    std::string fitting = "; these do: ", last;
    for (const tool::Template& robot : tool::templates()) {
      const std::string name(robot.name);
      CAPTURE(board, name);
      const Outcome made =
          test::rsc({"new", folder.path(name), "--template", name, "--board", std::string(board)});
      if (made.exit == 0) {
        check_made(folder, name, board);
        fitting += (last.empty() ? "" : ", ") + name;
        last = name;
        continue;
      }
      CHECK(made.exit == 2);
      CHECK_THAT(made.err, Contains("the template " + name + " does not fit the board " +
                                    std::string(board) + ": "));
      CHECK_FALSE(folder.has(name));
      ++refused;
    }
    const Outcome none =
        test::rsc({"new", folder.path("x"), "--template", "puppet", "--board", std::string(board)});
    if (none.exit != 0) CHECK_THAT(none.err, Catch::EndsWith(fitting + "\n"));
  }
  CHECK(refused > 0);
}

TEST_CASE("a board without a template gets a robot of its own, or else the first that fits") {
  const Folder folder;
  for (const std::string_view board : compiler::board_names()) {
    const std::string place(board);
    CAPTURE(board);
    CHECK(test::rsc({"new", folder.path(place), "--board", place}).exit == 0);
    check_made(folder, place, board);
  }
  CHECK(test::rsc({"new", folder.path("m"), "--template", "microbit"}).exit == 0);
  for (const char* const file : {"/robot.rsl", "/robot.json"})
    CHECK(folder.read(std::string("microbit-v2") + file) == folder.read(std::string("m") + file));
  CHECK(folder.read("m/robot.json").find("pin") == std::string::npos);  // nothing is wired
  const Outcome unknown = test::rsc({"new", folder.path("u"), "--board", "microbit"});
  CHECK(unknown.exit == 2);
  CHECK_THAT(unknown.err, Contains("microbit-v2"));
  CHECK(test::rsc({"new", folder.path("mod"), "--module", "--board", "microbit-v2"}).exit == 2);
}

TEST_CASE("a file that is there stays as it is, and no other is written") {
  const Folder folder;
  folder.write("robot.json", "mine");
  const Outcome refused = test::rsc({"new", folder.path(".")});
  CHECK(refused.exit == 3);
  CHECK_THAT(refused.err, Contains("robot.json already exists"));
  CHECK(folder.read("robot.json") == "mine");
  CHECK(folder.files() == 1);
}

TEST_CASE("a folder that cannot be made, or written to, is named") {
  const Folder folder;
  const std::string file = folder.write("file", "");
  const Outcome below_a_file = test::rsc({"new", file + "/robot"});
  CHECK(below_a_file.exit == 3);
  CHECK_THAT(below_a_file.err, Contains("cannot make the folder " + file + "/robot"));
  CHECK(test::rsc({"new", file}).exit == 3);
  CHECK(folder.files() == 1);
}

TEST_CASE("the folder is shown as a shell reads it") {
  const Folder folder;
  const std::string blank = folder.path("my robot's"), dash = folder.path("d");
  CHECK_THAT(test::rsc({"new", blank}).out,
             Contains("  cd '" + folder.path("my robot'\\''s") + "'\n"));
  CHECK_THAT(test::rsc({"new", "--module", dash}).out, Contains("  cd " + dash + "\n"));
}

TEST_CASE("an unknown template is answered with the known ones") {
  const Folder folder;
  const Outcome outcome = test::rsc({"new", folder.path("robot"), "--template", "kompanion"});
  CHECK(outcome.exit == 2);
  CHECK_THAT(outcome.err, Contains("companion"));
  CHECK(folder.files() == 0);
}

TEST_CASE("what cannot be written whole is not there at all") {
  const Folder folder;
  const std::string place = folder.path("robot");
  // No file may have more than 1,024 bytes, as on a full disk: robot.json has less, robot.rsl more.
  const std::string command =
      "trap '' XFSZ; ulimit -f 2; " RSC_BINARY " new " + place + " 2> " + folder.path("said");
  CHECK(WEXITSTATUS(std::system(("sh -c \"" + command + "\"").c_str())) == 3);
  CHECK_THAT(folder.read("said"), Contains("cannot write " + place + "/robot.rsl"));
  CHECK_FALSE(folder.has("robot"));
}
