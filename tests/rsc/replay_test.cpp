// rsc replay: what was recorded runs again, to the same commands; and it says where it does not.
#include <filesystem>

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "rsc/trace/replay_file.hpp"
#include "tests/rsc/image.hpp"
#include "tests/rsc/process.hpp"

using namespace robosync;
using Catch::Contains;
using nlohmann::json;
using test::Outcome;
using test::RobotFolder;
namespace fs = std::filesystem;

namespace {

// The small robot, run with some touches.
struct Recorded : RobotFolder {
  Recorded() {
    const std::string scenario = write("visit.json", R"({"duration": "6s", "stimuli": [
      {"at": "0s", "sensor": "touch", "value": 5}, {"at": "1.003s", "sensor": "touch", "value": 2},
      {"at": "2s", "sensor": "touch", "value": 4}, {"at": "3s", "sensor": "touch", "value": 1}]})");
    const Outcome outcome = test::rsc({"run", program, "--scenario", scenario, "--record",
                                       path("r.jsonl"), "--trace", path("t.jsonl")});
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit == 0);
  }
  [[nodiscard]] Outcome replay(const std::string& text,
                               const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"replay", write("changed.jsonl", text)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::rsc(arguments);
  }
  // The recording, in which the first `what` is `by`.
  [[nodiscard]] std::string with(const std::string& what, const std::string& by) const {
    std::string text = read("r.jsonl");
    const std::size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), by);
  }
};

}  // namespace

TEST_CASE("every example's run is replayed to the same") {
  const test::Folder folder;
  std::size_t runs = 0, commands = 0;
  for (const auto& entry : fs::recursive_directory_iterator(EXAMPLES)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".json" || name == "robot.json") continue;
    const std::string program = (entry.path().parent_path() / "robot.rsl").string();
    CAPTURE(program, name);
    Outcome outcome =
        test::rsc({"run", program, "--scenario", entry.path().string(), "--record",
                   folder.path("r.jsonl"), "--kept", folder.path(name + "kept"), "--seed", "7"});
    REQUIRE(outcome.exit == 0);
    outcome = test::rsc({"replay", folder.path("r.jsonl"), "--format", "json"});
    CAPTURE(outcome.out, outcome.err);
    CHECK(outcome.exit == 0);
    const json report = json::parse(outcome.out);
    CHECK(report.at("not_replayed") == 0);
    CHECK(report.at("programs").at(0).at("difference").is_null());
    CHECK(report.at("programs").at(0).at("events") > 0);
    commands += report.at("programs").at(0).at("commands").get<std::size_t>();
    ++runs;
  }
  CHECK(runs >= 17);
  CHECK(commands > 100);
}

TEST_CASE("what an algorithm puts out at one sample is one step in the replay, too") {
  const test::Folder folder;
  folder.write("robot.json", R"({
    "sensors": [{"name": "pad", "type": "VIRTUAL", "channels": {"FORCE": {"unit": "N", "range": [0, 20]}}}],
    "actuators": [{"name": "voice", "type": "VIRTUAL", "device": "speaker"}],
    "algorithms": [{"name": "touch", "module": "touch_levels", "input": "pad",
                    "config": {"light": "0.5N", "firm": "4N"}}]})");
  const std::string program = folder.write("robot.rsl", R"(WHEN touch LEVEL BECOMES none
DO
  IF touch TOUCH IS tap
  DO SAY "A tap"
  ELSE SAY "Gone"
  END
END
)");
  const std::string scenario = folder.write("tap.json", R"({"duration": "3s", "stimuli": [
    {"at": "0s", "sensor": "pad", "value": "0N"}, {"at": "1s", "sensor": "pad", "value": "1N"},
    {"at": "1.2s", "sensor": "pad", "value": "0N"}]})");
  const Outcome ran =
      test::rsc({"run", program, "--scenario", scenario, "--record", folder.path("r.jsonl")});
  CHECK_THAT(ran.out, Contains("SAY A tap"));
  const Outcome again = test::rsc({"replay", folder.path("r.jsonl")});
  CAPTURE(again.out, again.err);
  CHECK(again.exit == 0);
}

TEST_CASE("a reading that came after a response of its millisecond had gone on is held back") {
  const test::Folder folder;
  (void)folder.write("robot.json", R"({
    "sensors": [{"name": "left", "type": "ADC", "pin": 44, "device": "analog"},
                {"name": "right", "type": "ADC", "pin": 45, "device": "analog"}],
    "actuators": [{"name": "arm", "type": "PWM", "pin": 4, "device": "servo"}]})");
  const std::string program = folder.write("robot.rsl", R"(
BEHAVIOR low PRIORITY 10
  WHEN left LEVEL > 50% DO
    MOVE arm TO 10deg
    WAIT 1s
    MOVE arm TO 20deg
  END
END
BEHAVIOR high PRIORITY 20
  WHEN right LEVEL > 50% DO MOVE arm TO 90deg END
END
)");
  const std::string scenario = folder.write("visit.json", R"({"duration": "3s", "stimuli": [
    {"at": "0s", "sensor": "left", "value": "1%"}, {"at": "0s", "sensor": "right", "value": "1%"},
    {"at": "1s", "sensor": "left", "value": "90%"}, {"at": "2s", "sensor": "right", "value": "90%"}]})");
  const Outcome run = test::rsc(
      {"run", program, "--scenario", scenario, "--all", "--record", folder.path("r.jsonl")});
  CAPTURE(run.err);
  REQUIRE_THAT(run.out, Contains("2.000 s  low, rule at line 3 goes on"));
  REQUIRE_THAT(run.out, Contains("2.000 s  high, rule at line 10 triggers"));
  const Outcome replay = test::rsc({"replay", folder.path("r.jsonl")});
  CHECK_THAT(replay.out, Contains("the same as recorded"));
  CHECK(replay.exit == 0);
}

TEST_CASE("replay says where a recording and its replay differ first") {
  const Recorded robot;
  Outcome outcome = robot.replay(robot.read("r.jsonl"));
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("the same as recorded"));

  outcome = robot.replay(robot.with(R"("to":90)", R"("to":91)"));
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.out, Contains("changed.jsonl:") && Contains(R"("to":91)") &&
                              Contains(R"("to":90)") && Contains("then a difference"));

  outcome = robot.replay(robot.with(R"("value":2)", R"("value":4)"));  // no touch below 3
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.out, Contains("recorded") && Contains(R"("event":"fire")"));

  // Times count, but for a board that is a little late.
  outcome = robot.replay(robot.with(R"({"t_us":1003000,"step":2,"event":"input")",
                                    R"({"t_us":982000,"step":2,"event":"input")"));
  CHECK(outcome.exit == 1);

  // One that ends too early.
  std::string text = robot.read("r.jsonl");
  const std::size_t fire = text.find(R"("event":"fire")");
  const std::size_t from = text.rfind('\n', fire) + 1, to = text.find('\n', fire) + 1;
  outcome = robot.replay(text.erase(from, to - from));
  CHECK(outcome.exit == 1);
}

// A recording in which steps without a reading came late, as on a board whose processor had something else to do.
TEST_CASE("what a board did some milliseconds late is told, and is no difference") {
  const RobotFolder robot;
  const std::string program =
      robot.write("joy.rsl",
                  "REMEMBER n = 0\nFEELING joy FROM 0% TO 100% START 50%\n  FADES TO 50% OVER 60s\n"
                  "WHEN touch LEVEL > 2 DO RAISE joy BY 40% END\n"
                  "EVERY 500ms DO MOVE left_arm TO 90deg OVER 100ms END\n"
                  "EVERY 505ms DO SET n TO n + 1 END\nEVERY 500ms DO SET n TO n + 2 END\n");
  const std::string visit = robot.write("visit.json", R"({"duration": "6s", "stimuli": [
      {"at": "1s", "sensor": "touch", "value": 5}]})");
  REQUIRE(test::rsc({"run", program, "--config", robot.path("robot.json"), "--scenario", visit,
                     "--record", robot.path("r.jsonl")})
              .exit == 0);
  // All that is told at one time comes at another one.
  const auto moved = [&](std::uint64_t from_ms, std::uint64_t to_ms) {
    std::string text = robot.read("r.jsonl");
    const std::string from = fmt::format(R"({{"t_us":{},)", from_ms * 1000);
    REQUIRE(text.find(from) != std::string::npos);
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos;)
      text.replace(at, from.size(), fmt::format(R"({{"t_us":{},)", to_ms * 1000));
    return robot.write("late.jsonl", text);
  };
  Outcome outcome = test::rsc({"replay", moved(2500, 2503)});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("the same as recorded") && Contains("by at most 3 ms"));
  outcome = test::rsc({"replay", moved(2500, 2520), "--format", "json"});
  CHECK(outcome.exit == 0);
  CHECK(json::parse(outcome.out).at("programs").at(0).at("late") > 0);
  CHECK(json::parse(outcome.out).at("programs").at(0).at("latest_us") == 20'000);
  CHECK(test::rsc({"replay", moved(2500, 2521)}).exit == 1);
  CHECK(test::rsc({"replay", moved(2500, 2499)}).exit == 1);  // nobody is early
  outcome = test::rsc({"replay", robot.path("r.jsonl"), "--format", "json"});
  CHECK(json::parse(outcome.out).at("programs").at(0).at("late") == 0);
  // One rule may come behind another one, but of one variable the values keep their order.
  CHECK(test::rsc({"replay", moved(500, 507)}).exit == 0);
  CHECK(test::rsc({"replay", moved(501, 505)}).exit == 0);
  CHECK(test::rsc({"replay", moved(501, 507)}).exit == 1);
}

TEST_CASE("a trace is replayed with the program that it was made of") {
  const Recorded robot;
  Outcome outcome = robot.replay(robot.read("t.jsonl"));
  CHECK(outcome.exit == 2);
  CHECK_THAT(outcome.err, Contains("changed.jsonl:1: ") && Contains("--program"));
  outcome = robot.replay(robot.read("t.jsonl"), {"--program", robot.program});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 0);
  const std::string other =
      robot.write("other.rsl", "WHEN touch LEVEL < 2 DO MOVE left_arm SLOWLY TO 90deg END\n");
  outcome = robot.replay(robot.read("t.jsonl"), {"--program", other});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.out, Contains("then a difference"));
  const std::string stranger =
      robot.write("stranger.rsl", "EVERY 1s DO MOVE left_arm SLOWLY TO 90deg END\n");
  outcome = robot.replay(robot.read("t.jsonl"), {"--program", stranger});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("this reading does not fit the program"));
}

TEST_CASE("--program runs in place of the program that was recorded, and the answer says so") {
  const Recorded robot;
  const std::string recording = robot.read("r.jsonl");
  Outcome outcome = robot.replay(recording, {"--program", robot.program});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("robot.rsl is the recorded program"));

  const std::string other =
      robot.write("other.rsl",
                  "WHEN touch LEVEL < 2 DO MOVE left_arm SLOWLY TO 90deg END\n"
                  "WHEN proximity DISTANCE < 20cm DO MOVE left_arm QUICKLY TO 0deg END\n");
  outcome = robot.replay(recording, {"--program", other});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.out, Contains("then a difference") &&
                              Contains("other.rsl ran instead of the recorded program"));
  outcome = robot.replay(recording, {"--program", other, "--format", "json"});
  CHECK(outcome.exit == 1);
  const json program = json::parse(outcome.out).at("programs").at(0);
  CHECK(program.at("in_its_place") == true);
  CHECK_FALSE(program.at("difference").is_null());
  CHECK_FALSE(json::parse(robot.replay(recording, {"--format", "json"}).out)
                  .at("programs")
                  .at(0)
                  .contains("in_its_place"));
}

TEST_CASE("what only the program in the place of the recorded one reads is named") {
  const RobotFolder robot;
  const std::string rule = "WHEN touch LEVEL < 3 DO MOVE left_arm SLOWLY TO 90deg END\n";
  const std::string more = rule + "WHEN proximity NOISE > 60dB DO MOVE left_arm TO 9deg END\n";
  const Outcome run = test::rsc({"run", robot.write("less.rsl", rule), "--record",
                                 robot.path("r.jsonl"), "--config", robot.path("robot.json")});
  REQUIRE(run.exit == 0);
  const Outcome outcome =
      test::rsc({"replay", robot.path("r.jsonl"), "--program", robot.write("more.rsl", more)});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("it reads proximity.NOISE, which was not recorded"));
}

// Two rules outside a BEHAVIOR, which are called by their lines, and one takes the arm from the other.
TEST_CASE("lines at which rules are written make no difference, what they decide does") {
  const RobotFolder robot;
  const std::string rules =
      "EVERY 1s DO MOVE left_arm SLOWLY TO 90deg END\n"
      "EVERY 1s DO MOVE left_arm SLOWLY TO 9deg END\n";
  const auto replay = [&](const std::string& recording, const std::string& text) {
    return test::rsc({"replay", robot.path(recording), "--program", robot.write("new.rsl", text)});
  };
  const Outcome run = test::rsc({"run", robot.write("old.rsl", rules), "--trace",
                                 robot.path("t.jsonl"), "--record", robot.path("r.jsonl")});
  REQUIRE(run.exit == 0);
  REQUIRE_THAT(robot.read("t.jsonl"), Contains(R"("by":"the rule at line )"));
  for (const char* recording : {"t.jsonl", "r.jsonl"}) {
    Outcome outcome = replay(recording, "# a remark\n\n" + rules);
    CAPTURE(recording, outcome.out, outcome.err);
    CHECK(outcome.exit == 0);
    outcome = replay(recording, "# a remark\nEVERY 1s DO MOVE left_arm SLOWLY TO 90deg END\n");
    CHECK(outcome.exit == 1);
  }
}

TEST_CASE("a recording with gaps is replayed as far as it is whole, and each program by itself") {
  const Recorded robot;
  const std::string once = robot.read("r.jsonl");
  const std::string gap = tool::gap_line("3 events did not fit on the line");
  Outcome outcome =
      robot.replay(once + gap + robot.read("t.jsonl").substr(60) + once, {"--format", "json"});
  CAPTURE(outcome.out, outcome.err);
  // The trace behind the gap begins within a line.
  CHECK(outcome.exit == 1);
  const std::string loose =
      R"({"t_us":9000000,"step":9,"event":"command","actuator":"left_arm","verb":"MOVE"})"
      "\n";
  // A command that nothing led to: between the last time that it was whole and the gap.
  outcome = robot.replay(loose + once + tool::whole_line() + loose + gap + loose + once,
                         {"--format", "json"});
  CAPTURE(outcome.out, outcome.err);
  REQUIRE(outcome.exit == 0);
  const json report = json::parse(outcome.out);
  CHECK(report.at("programs").size() == 2);
  CHECK(report.at("programs").at(0).at("gap") == "3 events did not fit on the line");
  CHECK(report.at("programs").at(1).at("gap").is_null());
  CHECK(report.at("programs").at(1).at("commands") == report.at("programs").at(0).at("commands"));
  CHECK(report.at("not_replayed") == 3);
}

TEST_CASE("what is no recording is said") {
  const Recorded robot;
  Outcome outcome = robot.replay(R"({"event":"board"})"
                                 "\n");
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("no program starts in it"));
  for (const char* hex : {"0", "0g", "00", "zz", "é"}) {
    outcome = robot.replay(std::string(R"({"event":"image","hex":")") + hex + "\"}\n" +
                           robot.read("t.jsonl"));
    CAPTURE(hex, outcome.err);
    CHECK(outcome.exit == 1);
    CHECK_THAT(outcome.err, Contains("changed.jsonl:"));
  }
  for (const char* value :
       {R"("value":1e300)", R"("value":null)", R"("value":"much")", R"("value":[2])"}) {
    outcome = robot.replay(robot.with(R"("value":2)", value));
    CAPTURE(value);
    CHECK(outcome.exit == 1);
    CHECK_THAT(outcome.err, Contains("this reading does not fit the program"));
  }
  CHECK(robot.replay(robot.with(R"("sensor":"touch")", R"("sensor":7)")).exit == 1);
}
