// rsc fmt: which files it writes, which stay as they are, and how it ends.
#include <cstdlib>
#include <filesystem>
#include <tuple>

#include <catch2/catch.hpp>

#include "tests/rsc/image.hpp"
#include "tests/rsc/process.hpp"

using namespace robosync;
using Catch::Contains;
using test::Folder;
using test::Outcome;

namespace {

constexpr const char* kPlain = "WHEN touch LEVEL<3\nDO\nLOG \"x\"\nEND\n";
constexpr const char* kStyled = "WHEN touch LEVEL < 3\nDO\n  LOG \"x\"\nEND\n";

}  // namespace

TEST_CASE("files that are not in the one style are written, and named") {
  const Folder folder;
  const std::string plain = folder.write("plain.rsl", kPlain);
  const std::string styled = folder.write("styled.rsl", kStyled);
  const Outcome outcome = test::rsc({"fmt", plain, styled});
  CHECK(outcome.exit == 0);
  CHECK(outcome.out == plain + "\n");
  CHECK(folder.read("plain.rsl") == kStyled);
  CHECK(test::rsc({"fmt", plain, styled}).out.empty());
}

TEST_CASE("--check changes nothing, and exits with 1 where something would") {
  const Folder folder;
  const std::string plain = folder.write("plain.rsl", kPlain);
  const Outcome outcome = test::rsc({"fmt", "--check", plain});
  CHECK(outcome.exit == 1);
  CHECK(outcome.out == plain + "\n");
  CHECK(folder.read("plain.rsl") == kPlain);
  CHECK(test::rsc({"fmt", "--check", folder.write("styled.rsl", kStyled)}).exit == 0);
}

TEST_CASE("a robot.json is formatted, too") {
  const Folder folder;
  const std::string plain = folder.write("robot.json", "{\"sensors\":[\n]}");
  CHECK(test::rsc({"fmt", "--check", plain}).exit == 1);
  CHECK(test::rsc({"fmt", plain}).out == plain + "\n");
  CHECK(folder.read("robot.json") == "{\n  \"sensors\": []\n}\n");
  const std::string wrong = folder.write("wrong.json", "{\"sensors\": [}\n");
  const Outcome outcome = test::rsc({"fmt", wrong});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err,
             Contains("error[E0201]") && Contains("1 error,") && Contains("it is unchanged"));
  CHECK(folder.read("wrong.json") == "{\"sensors\": [}\n");
  // Its name tells, too.
  CHECK_THAT(test::rsc({"fmt", folder.write("begun.JSON", "[1,\n")}).err, Contains("error[E0201]"));
}

TEST_CASE("a program with a mistake stays as it is, and the others are written") {
  const Folder folder;
  const std::string wrong = folder.write("wrong.rsl", "WHEN touch LEVEL<\n");
  const Outcome outcome = test::rsc({"fmt", wrong, folder.write("plain.rsl", kPlain)});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("error[") && Contains("it is unchanged"));
  CHECK(folder.read("wrong.rsl") == "WHEN touch LEVEL<\n");
  CHECK(folder.read("plain.rsl") == kStyled);
}

TEST_CASE("fmt and fix change the file that a link leads to") {
  const test::RobotFolder robot;
  std::filesystem::create_symlink("robot.rsl", robot.path("link.rsl"));
  const auto still_one = [&](const std::string& text) {
    CHECK(robot.read("robot.rsl") == text);
    CHECK(std::filesystem::is_symlink(robot.path("link.rsl")));
  };
  robot.write("robot.rsl", kPlain);
  CHECK(test::rsc({"fmt", robot.path("link.rsl")}).exit == 0);
  still_one(kStyled);
  robot.write("robot.rsl", "WHEN tuoch LEVEL < 3\nDO\n  LOG \"x\"\nEND\n");
  const Outcome outcome = test::rsc({"fix", robot.path("link.rsl")});
  CAPTURE(outcome.out, outcome.err);
  still_one(kStyled);
}

TEST_CASE("- reads stdin and writes stdout") {
  const Folder folder;
  const auto piped = [&](const std::string& program, const std::string& check = "") {
    const std::string command = RSC_BINARY " fmt - " + check + " < " +
                                folder.write("in.rsl", program) + " > " + folder.path("out.rsl") +
                                " 2> " + folder.path("said");
    return WEXITSTATUS(std::system(command.c_str()));
  };
  CHECK(piped(kPlain) == 0);
  CHECK(folder.read("out.rsl") == kStyled);
  CHECK(piped("{\"name\":\"ada\"}") == 0);
  CHECK(folder.read("out.rsl") == "{\n  \"name\": \"ada\"\n}\n");
  CHECK(piped("WHEN touch LEVEL<\n") == 1);
  CHECK(folder.read("out.rsl") == "WHEN touch LEVEL<\n");
  CHECK_THAT(folder.read("said"), Contains("<stdin>:1:"));
  for (const auto& [program, exit, out] :
       {std::tuple{kPlain, 1, "<stdin>\n"}, {kStyled, 0, ""}, {"WHEN touch LEVEL<\n", 1, ""}}) {
    CHECK(piped(program, "--check") == exit);
    CHECK(folder.read("out.rsl") == out);
  }
  CHECK(piped(kPlain, "--check -q") == 1);
  CHECK(folder.read("out.rsl").empty());
}
