// rsc new: what it makes works as it stands, and nothing that is there is touched.
#include <cstdlib>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

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
