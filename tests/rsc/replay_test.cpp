// rsc replay: what was recorded runs again, to the same commands; and it says where it does not.
#include <algorithm>
#include <filesystem>
#include <sstream>
#include <utility>

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

// A robot with two knobs: the left one is turned up at 1 s, the right one at 2 s.
struct TwoKnobs : test::Folder {
  // What `rsc run` shows of the program. The run is recorded.
  [[nodiscard]] std::string run(const std::string& rsl) const {
    (void)write("robot.json", R"({
      "sensors": [{"name": "left", "type": "ADC", "pin": 44, "device": "analog"},
                  {"name": "right", "type": "ADC", "pin": 45, "device": "analog"}],
      "actuators": [{"name": "arm", "type": "PWM", "pin": 4, "device": "servo"}]})");
    const std::string scenario = write("visit.json", R"({"duration": "4s", "stimuli": [
      {"at": "0s", "sensor": "left", "value": "1%"}, {"at": "0s", "sensor": "right", "value": "1%"},
      {"at": "1s", "sensor": "left", "value": "90%"}, {"at": "2s", "sensor": "right", "value": "90%"}]})");
    const Outcome outcome = test::rsc({"run", write("robot.rsl", rsl), "--scenario", scenario,
                                       "--all", "--record", path("r.jsonl")});
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit == 0);
    return outcome.out;
  }
  void expect_same_replay() const {
    const Outcome replay = test::rsc({"replay", path("r.jsonl")});
    CHECK_THAT(replay.out, Contains("the same as recorded"));
    CHECK(replay.exit == 0);
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
  const TwoKnobs robot;
  const std::string told = robot.run(R"(
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
  REQUIRE_THAT(told, Contains("2.000 s  low, rule at line 3 goes on"));
  REQUIRE_THAT(told, Contains("2.000 s  high, rule at line 10 triggers"));
  robot.expect_same_replay();
}

TEST_CASE(
    "a reading is held back behind no more than the step before it, though a WHILE begins its next "
    "round") {
  const TwoKnobs robot;
  const std::string told = robot.run(R"(BEHAVIOR low PRIORITY 10
  WHILE left LEVEL > 50% DO
    MOVE arm TO 10deg
    WAIT 1s
  END
END
BEHAVIOR high PRIORITY 20
  WHEN right LEVEL > 50% DO MOVE arm TO 90deg END
END
)");
  REQUIRE_THAT(told, Contains("2.000 s  low, rule at line 2 is finished\n"
                              "   2.000 s  right LEVEL = 90%"));
  robot.expect_same_replay();
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

namespace {

// The lines of a recording of a robot whose arm SAFETY halts.
struct Guarded : RobotFolder {
  Guarded() {
    write("force.json", R"({
      "sensors": [{"name": "force", "type": "VIRTUAL", "channels": {"F": {"range": [0, 100], "stale_after": "60s"}}}],
      "actuators": [{"name": "arm", "device": "servo", "pin": 10}], "safety": {"start": "2s"}})");
    const std::string guarded = write("force.rsl", R"(SAFETY squeeze
  WHEN force F > 50
  DO
    STOP arm
    ALERT "squeezed at", force F
  RESUME WHEN force F < 20 FOR 100ms
END
SAFETY crush
  WHEN force F > 95
  DO STOP arm
END
)");
    const std::string scenario = write("visit.json", R"({"duration": "5s", "stimuli": [
      {"at": "0s", "sensor": "force", "value": 1}, {"at": "1s", "sensor": "force", "value": 90},
      {"at": "2s", "sensor": "force", "value": 3}, {"at": "3s", "sensor": "force", "value": 60}]})");
    REQUIRE(test::rsc({"run", guarded, "--config", path("force.json"), "--scenario", scenario,
                       "--record", path("r.jsonl")})
                .exit == 0);
    for (std::istringstream text(read("r.jsonl")); std::getline(text, lines.emplace_back());) {
    }
    lines.pop_back();
  }
  // The readings at this time are told so much later, as by a step that had to wait.
  void tell_later(std::uint64_t at_us, std::uint64_t by_us) {
    for (std::string& line : lines) {
      const json event = json::parse(line);
      if (event.value("t_us", std::uint64_t{1}) != at_us || event.at("event") != "input") continue;
      line = fmt::format(R"({{"t_us":{},)", at_us + by_us) + line.substr(line.find(R"("step")"));
    }
    const auto time_of = [](const std::string& line) { return json::parse(line).value("t_us", 0); };
    std::ranges::stable_sort(lines, {}, time_of);  // the image has no time
  }
  // The first line with all of these parts.
  [[nodiscard]] std::size_t line_with(const std::string& part, const std::string& more) const {
    const auto found = std::ranges::find_if(lines, [&](const std::string& line) {
      return line.find(part) != std::string::npos && line.find(more) != std::string::npos;
    });
    REQUIRE(found != lines.end());
    return static_cast<std::size_t>(found - lines.begin());
  }
  [[nodiscard]] Outcome replay() const {
    std::string text;
    for (const std::string& line : lines)
      text += line + "\n";
    return test::rsc({"replay", write("changed.jsonl", text), "--format", "json"});
  }

  std::vector<std::string> lines;
};

json program_of(const Outcome& outcome) {
  return json::parse(outcome.out).at("programs").at(0);
}

}  // namespace

TEST_CASE("SAFETY may trip some milliseconds before the step that tells its reading, not more") {
  for (const auto& [by_us, exit] : {std::pair{1'000, 0}, {20'000, 0}, {21'000, 1}}) {
    Guarded robot;
    robot.tell_later(1'000'000, static_cast<std::uint64_t>(by_us));
    const Outcome outcome = robot.replay();
    CAPTURE(by_us, outcome.out, outcome.err);
    CHECK(outcome.exit == exit);
    if (exit != 0) continue;
    CHECK(program_of(outcome).at("early") == 3);  // trip, halt and alert
    CHECK(program_of(outcome).at("earliest_us") == by_us);
    CHECK(program_of(outcome).at("late") == 0);
  }
  // One that lets go after a while does so from the reading on, too.
  Guarded robot;
  robot.tell_later(2'000'000, 2'000);
  Outcome outcome = robot.replay();
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 0);
  CHECK(program_of(outcome).at("early") == 2);  // resume and release
  outcome = test::rsc({"replay", robot.path("changed.jsonl")});
  CHECK_THAT(outcome.out,
             Contains("2 of the events were recorded earlier than in the replay, by at most 2 ms"));
}

TEST_CASE("a first reading that its step tells late trips no rule of the replay") {
  for (const auto& [by_us, exit] : {std::pair{1'000, 0}, {5'000, 0}, {20'000, 0}, {21'000, 1}}) {
    Guarded robot;
    robot.tell_later(0, static_cast<std::uint64_t>(by_us));
    const Outcome outcome = robot.replay();
    CAPTURE(by_us, outcome.out, outcome.err);
    CHECK(outcome.exit == exit);
  }
}

TEST_CASE(
    "a trip that is missing, additional or another one is a difference, also beside late steps") {
  for (const std::uint64_t late_us : {0, 1'000}) {
    Guarded missing;
    missing.tell_later(1'000'000, late_us);
    missing.lines.erase(missing.lines.begin() + static_cast<std::ptrdiff_t>(missing.line_with(
                                                    R"("trip")", R"("t_us":1000000,)")));
    Guarded more;
    more.tell_later(1'000'000, late_us);
    const std::size_t first = more.line_with(R"("input")", R"("value":90)");
    more.lines.insert(more.lines.begin() + static_cast<std::ptrdiff_t>(first),
                      R"({"t_us":1000000,"step":1,"event":"trip","rule":2,"line":8})");
    Guarded other;
    other.tell_later(1'000'000, late_us);
    std::string& trip = other.lines[other.line_with(R"("trip")", R"("t_us":1000000,)")];
    trip = R"({"t_us":1000000,"step":1,"event":"trip","rule":2,"line":8})";
    for (const Guarded* const robot : {&missing, &more, &other}) {
      const Outcome outcome = robot->replay();
      CAPTURE(late_us, outcome.out, outcome.err);
      CHECK(outcome.exit == 1);
      CHECK_FALSE(program_of(outcome).at("difference").is_null());
    }
  }
}

TEST_CASE("a time that was measured may differ as much as events were late") {
  const RobotFolder robot;
  const std::string program = robot.write("time.rsl", R"(TIMER trial
REMEMBER took = 0s
WHEN touch LEVEL > 2 FOR 200ms DO
  SET took TO trial
  LOG "touch", touch LEVEL, "at", trial
END
EVERY 1s DO LOG "so far", trial END
)");
  const std::string visit = robot.write("visit.json", R"({"duration": "3s", "stimuli": [
    {"at": "0s", "sensor": "touch", "value": 0}, {"at": "1.5s", "sensor": "touch", "value": 5}]})");
  REQUIRE(test::rsc({"run", program, "--config", robot.path("robot.json"), "--scenario", visit,
                     "--record", robot.path("r.jsonl")})
              .exit == 0);
  const auto changed = [&](const std::vector<std::pair<std::string, std::string>>& all) {
    std::string text = robot.read("r.jsonl");
    for (const auto& [from, to] : all) {
      CAPTURE(from, text);
      REQUIRE(text.find(from) != std::string::npos);
      for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    }
    return test::rsc({"replay", robot.write("changed.jsonl", text)});
  };
  using Changes = std::vector<std::pair<std::string, std::string>>;
  const Changes late = {{R"("t_us":1700000)", R"("t_us":1702000)"},
                        {R"("t_us":1701000)", R"("t_us":1703000)"}};
  Changes as_measured = late;
  as_measured.insert(as_measured.end(), {{"at 1.7s", "at 1.702s"},
                                         {"[5,1.7]", "[5,1.702]"},
                                         {R"("took","value":1.7)", R"("took","value":1.702)"}});
  const Outcome outcome = changed(as_measured);
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 0);
  // Without a late event, by more than it was late, and in what is no time, it is a difference.
  CHECK(changed({{"at 1.7s", "at 1.702s"}, {"[5,1.7]", "[5,1.702]"}}).exit == 1);
  Changes too_much = late;
  too_much.insert(too_much.end(), {{"at 1.7s", "at 1.703s"}, {"[5,1.7]", "[5,1.703]"}});
  CHECK(changed(too_much).exit == 1);
  Changes wrong = as_measured;
  wrong.insert(wrong.end(), {{"touch 5 at", "touch 6 at"}, {"[5,1.702]", "[6,1.702]"}});
  CHECK(changed(wrong).exit == 1);
  Changes only_text = late;
  only_text.emplace_back("at 1.7s", "at 1.702s");  // the text belongs to its values
  CHECK(changed(only_text).exit == 1);
}

TEST_CASE("a KEPT number begins as recorded, whatever the program in the place declares") {
  const RobotFolder robot;
  robot.write("numbers.json", R"({"kept": {"visits": 4}})");
  const auto text = [](int begin, const char* more) {
    return fmt::format(
        "REMEMBER visits = {} KEPT\nREMEMBER other = {} KEPT\nAT START DO\n  "
        "RAISE visits BY 1\n  LOG \"visit\", visits\nEND\n{}",
        begin, begin, more);
  };
  REQUIRE(
      test::rsc({"run", robot.write("old.rsl", text(0, "")), "--kept", robot.path("numbers.json"),
                 "--duration", "1s", "--record", robot.path("r.jsonl")})
          .exit == 0);
  const Outcome outcome = test::rsc({"replay", robot.path("r.jsonl"), "--program",
                                     robot.write("new.rsl", text(7, "# the same\n"))});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 0);
  CHECK_THAT(robot.read("r.jsonl"), Contains("visit 5"));
}
