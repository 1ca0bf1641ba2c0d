// rsc run --watch and rsc monitor --upload: a real process, whose program, configuration and modules somebody edits meanwhile.
#include <csignal>
#include <filesystem>
#include <sstream>
#include <string>

#include <catch2/catch.hpp>

#include "tests/rsc/device.hpp"
#include "tests/rsc/image.hpp"
#include "tests/rsc/process.hpp"

using namespace robosync;
using Catch::Contains;
using test::Folder;
using test::Outcome;
using test::RobotFolder;
using test::Running;

namespace {

constexpr const char* kWaits = "waiting until a file is saved";

std::string program_that_logs(const std::string& text) {
  return "AT START DO\n  LOG \"" + text + "\"\nEND\n";
}

std::size_t lines_with(const std::string& text, const std::string& part) {
  std::istringstream stream(text);
  std::size_t count = 0;
  for (std::string line; std::getline(stream, line);)
    if (line.find(part) != std::string::npos) ++count;
  return count;
}

}  // namespace

TEST_CASE("run --watch runs again when the program is saved, and outlives its mistakes") {
  const RobotFolder robot;
  robot.write("robot.rsl", program_that_logs("first"));
  Running watch({"run", robot.program, "--watch"});
  REQUIRE(watch.has_said(kWaits, 1));
  CHECK(lines_with(watch.out(), "first") == 1);

  robot.write("robot.rsl", program_that_logs("the second"));
  REQUIRE(watch.has_said(kWaits, 2));
  CHECK(lines_with(watch.out(), "the second") == 1);
  CHECK(lines_with(watch.err(), "error") == 0);

  robot.write("robot.rsl", "AT START DO\n  LGO \"third\"\nEND\n");
  REQUIRE(watch.has_said(kWaits, 3));
  CHECK(lines_with(watch.err(), "error[") == 1);
  CHECK_THAT(watch.err(), Contains("robot.rsl: 1 error"));
  CHECK(lines_with(watch.out(), "third") == 0);

  robot.write("robot.rsl", program_that_logs("the fourth"));
  REQUIRE(watch.has_said(kWaits, 4));
  const Outcome outcome = watch.end(SIGINT);
  CHECK(outcome.exit == 0);
  CHECK(lines_with(outcome.out, "first") == 1);
  CHECK(lines_with(outcome.out, "the fourth") == 1);
  CHECK(lines_with(outcome.err, "error[") == 1);
}

TEST_CASE("run --watch notices the configuration that was not there, a module, and its end") {
  const Folder folder;
  const std::string program =
      folder.write("pet.rsl", "USE \"talk.rsl\"\nAT START DO\n  talk\nEND\n");
  folder.write("talk.rsl", "DEFINE talk\n  LOG \"hello\"\nEND\n");
  Running watch({"run", program, "--watch"});
  REQUIRE(watch.has_said(kWaits, 1));
  CHECK_THAT(watch.err(), Contains("no configuration"));

  folder.write("robot.json", test::kRobot);
  REQUIRE(watch.has_said(kWaits, 2));
  CHECK(lines_with(watch.out(), "hello") == 1);

  folder.write("talk.rsl", "DEFINE talk\n  LOG \"good evening\"\nEND\n");
  REQUIRE(watch.has_said(kWaits, 3));
  const Outcome outcome = watch.end(SIGTERM);
  CHECK(outcome.exit == 0);
  CHECK(lines_with(outcome.out, "good evening") == 1);
}

TEST_CASE("run --watch does not outlive wrong usage") {
  const RobotFolder robot;
  const Outcome outcome =
      test::rsc({"run", robot.program, "--watch", "--trace", robot.path("robot.json")});
  CHECK(outcome.exit == 2);
  CHECK(robot.read("robot.json") == test::kRobot);
}

TEST_CASE("a monitor that uploads waits for a file that is gone for a moment") {
  const test::Device device;
  const std::string record = device.path("r.jsonl");
  const std::string program =
      device.write("robot.rsl", "EVERY 100ms DO MOVE left_arm QUICKLY TO 10deg END\n");
  Running monitor({"monitor", "--upload", program, "--record", record, "--port", device.port});
  CHECK(monitor.has_written(record, R"("to":10)", 1));
  std::filesystem::remove(program);
  CHECK(monitor.has_said("cannot read " + program, 1));
  device.write("robot.rsl", "EVERY 100ms DO MOVE left_arm QUICKLY TO 20deg END\n");
  CHECK(monitor.has_written(record, R"("to":20)", 1));
  CHECK(monitor.end(SIGINT).exit == 0);
}
