// rsc test: every kind of expectation once as it comes and once as it does not, mistakes in TEST
// blocks, and both reports.
#include <algorithm>
#include <sstream>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/rsc/process.hpp"

using namespace robosync;
using Catch::Contains;
using nlohmann::json;
using test::Folder;
using test::Outcome;

namespace {

constexpr const char* kRobot = R"({
  "sensors": [
    {"name": "touch", "type": "VIRTUAL",
     "channels": {"LEVEL": {"range": [0, 10]}, "PLACE": {"range": [0, 10]}}},
    {"name": "proximity", "type": "VIRTUAL",
     "channels": {"DISTANCE": {"unit": "cm", "range": [2, 400]}}},
    {"name": "button", "type": "VIRTUAL", "channels": {"POSITION": {"labels": ["released", "pressed"]}}},
    {"name": "waved", "type": "VIRTUAL", "channels": {"SEEN": {"truth": true}}}
  ],
  "actuators": [
    {"name": "left_arm", "type": "PWM", "pin": 10, "device": "servo", "range": ["0deg", "120deg"]},
    {"name": "right_arm", "type": "PWM", "pin": 11, "device": "servo", "range": ["0deg", "120deg"]},
    {"name": "sound", "type": "VIRTUAL", "device": "speaker",
     "sounds": ["greeting.wav", "warning.wav"]}
  ],
  "groups": {"arms": ["left_arm", "right_arm"]}
})";

constexpr const char* kTestedProgram = R"(STATE mood: calm, scared
REMEMBER touches = 0

SAFETY stop_button
  WHEN button IS pressed
  DO
    STOP arms
    ALERT "Stopped by a person"
  RESUME WHEN button IS released
END

BEHAVIOR feel PRIORITY 50
  WHEN touch LEVEL > 3
  DO
    SET mood TO scared
    SET touches TO touches + 1
    LOG "touched with", touch LEVEL
    MOVE arms TO 90deg QUICKLY
    PLAY sound "warning.wav"
  END
  WHEN waved
  DO MOVE left_arm TO 20deg SLOWLY
  END
END
)";

struct TestFolder : Folder {
  explicit TestFolder(const std::string& tests) {
    write("robot.json", kRobot);
    write("robot.rsl", kTestedProgram + tests);
  }
  std::string program = path("robot.rsl");
};

// A touch at 1 s; the button is not pressed.
std::string touched(const std::string& title, const std::string& steps) {
  return "TEST \"" + title + "\"\n  AT 0s button = \"released\"\n  AT 0s touch LEVEL = 0\n" +
         "  AT 1s touch LEVEL = 5\n  " + steps + "\nEND\n";
}

}  // namespace

TEST_CASE("every kind of expectation, met and not met") {
  struct Case {
    bool met;
    const char* steps;
  };
  const std::vector<Case> cases = {
      // a command: verb, all members, word, parameters; only what is written counts
      {true, "EXPECT MOVE arms TO 90deg QUICKLY WITHIN 20ms"},
      {true, "EXPECT MOVE arms WITHIN 20ms"},
      {true, "EXPECT MOVE arms WITHIN 0s"},  // both ends of a window belong to it
      {true, "AT 3s waved = TRUE\n  WAIT 0s\n  EXPECT NO MOVE right_arm WITHIN 1s"},
      {true, "EXPECT MOVE left_arm TO 90deg WITHIN 20ms"},
      {true, "EXPECT PLAY sound \"warning.wav\" WITHIN 20ms"},
      {false, "EXPECT MOVE arms TO 80deg WITHIN 1s"},
      {false, "EXPECT MOVE arms SLOWLY WITHIN 1s"},
      {false, "EXPECT TURN arms WITHIN 1s"},
      {false, "EXPECT PLAY sound \"greeting.wav\" WITHIN 1s"},
      {false, "WAIT 100ms\n  EXPECT MOVE arms WITHIN 1s"},  // it is over by then
      {true, "AT 3s waved = TRUE\n  EXPECT MOVE left_arm TO 20deg WITHIN 20ms"},
      {false, "AT 3s waved = FALSE\n  EXPECT MOVE left_arm TO 20deg WITHIN 1s"},
      {false, "AT 3s waved = TRUE\n  EXPECT MOVE arms TO 20deg WITHIN 1s"},  // the left one only
      // none
      {true, "EXPECT NO MOVE arms TO 80deg WITHIN 5s"},
      {false, "EXPECT NO MOVE right_arm WITHIN 5s"},
      {true, "WAIT 5s\n  EXPECT NOTHING FOR 5s"},
      {false, "EXPECT NOTHING FOR 1s"},
      // windows begin where the test stands and do not add up
      {true, "EXPECT MOVE arms WITHIN 1s\n  EXPECT PLAY sound WITHIN 20ms"},
      // values: those the program looks at, those it does not, what it remembers
      {true, "WAIT 10ms\n  EXPECT THAT mood IS scared"},
      {true, "EXPECT THAT mood IS scared WITHIN 20ms"},
      {false, "EXPECT THAT mood IS calm AND touch LEVEL < 5 WITHIN 1s"},
      {true, "WAIT 10ms\n  EXPECT THAT touches = 1 AND touch LEVEL = 5"},
      {false, "WAIT 10ms\n  EXPECT THAT touches = 2"},
      {true, "AT 2s touch PLACE = 7\n  EXPECT THAT touch PLACE * 2 > 13"},
      {false, "EXPECT THAT proximity DISTANCE > 0cm WITHIN 1s"},  // unknown
      // how often
      {true, "EXPECT 1 TIMES MOVE arms WITHIN 5s"},
      {false, "EXPECT 2 TIMES MOVE arms WITHIN 5s"},
      {true, "EXPECT 0 TIMES MOVE arms TO 80deg WITHIN 5s"},
      {true,
       "AT 2s touch LEVEL = 0\n  AT 3s touch LEVEL = 5\n  EXPECT 1 TIMES MOVE arms WITHIN 1s"},
      // texts: the words, and what may follow them
      {true, "EXPECT LOG \"touched with\" WITHIN 20ms"},
      {true, "EXPECT LOG \"touched with 5\" WITHIN 20ms"},
      {true, "EXPECT LOG \"touched\""},
      {false, "EXPECT LOG \"touched wi\" WITHIN 1s"},
      {false, "EXPECT LOG \"touched with 6\" WITHIN 1s"},
      {false, "EXPECT ALERT \"touched\" WITHIN 1s"},
      {false, "EXPECT NO LOG \"touched\" WITHIN 1s"},
      {true, "EXPECT NO ALERT \"Stopped\" WITHIN 1s"},
      {true, "AT 2s button = \"pressed\"\n  EXPECT ALERT \"Stopped by a person\" WITHIN 20ms"},
      {false, "AT 2s button = \"pressed\"\n  EXPECT NO ALERT \"Stopped\" WITHIN 20ms"},
      {true, "SEED 7\n  EXPECT MOVE arms WITHIN 20ms"},
      // stops
      {true, "AT 2s button = \"pressed\"\n  WAIT 1s\n  EXPECT STOPPED arms"},
      {false, "EXPECT STOPPED arms"},
      {true, "EXPECT NO STOPPED arms"},
      {true, "AT 2s button = \"pressed\"\n  EXPECT STOPPED arms WITHIN 5ms"},
      {true, "AT 9s button = \"pressed\"\n  EXPECT NO STOPPED sound WITHIN 1s"},
      {true, "AT 2s button = \"pressed\"\n  WAIT 1s\n  EXPECT STOPPED left_arm WITHIN 1ms"},
      {false, "EXPECT STOPPED arms WITHIN 500ms"},
      {false, "AT 2s button = \"pressed\"\n  EXPECT NO STOPPED right_arm WITHIN 1s"},
  };
  std::string tests;
  for (std::size_t i = 0; i < cases.size(); ++i)
    tests += touched(std::to_string(i), cases[i].steps);
  const TestFolder robot(tests);
  const Outcome outcome = test::rsc({"test", robot.program, "--format", "json"});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit == 1);
  const json report = json::parse(outcome.out);
  REQUIRE(report.at("tests").size() == cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    INFO(cases[i].steps << "\n" << report.at("tests").at(i).dump(2));
    CHECK(report.at("tests").at(i).at("ok") == cases[i].met);
  }
  const auto met = std::ranges::count_if(cases, [](const Case& one) { return one.met; });
  CHECK(report.at("passed") == met);
  CHECK(report.at("failed") == static_cast<std::ptrdiff_t>(cases.size()) - met);
}

TEST_CASE("SAFETY knows at the start what a sensor measures then, also one that takes a while") {
  const Folder folder;
  folder.write("robot.json", R"({
    "sensors": [{"name": "wall", "type": "I2C", "address": "0x29", "device": "vl53l0x"}],
    "actuators": [{"name": "wheel", "type": "PWM", "pins": [4, 5], "device": "motor"}]})");
  const std::string program = folder.write("robot.rsl", R"(
SAFETY near
  WHEN wall DISTANCE < 10cm
  DO STOP wheel
  RESUME WHEN wall DISTANCE > 20cm
END
AT START
DO RUN wheel FORWARD
END
TEST "it begins"
  AT 0s wall DISTANCE = 1m
  EXPECT RUN wheel WITHIN 0ms
END
)");
  const Outcome tested = rsc({"test", program});
  INFO(tested.out << tested.err);
  CHECK(tested.exit == 0);
}

TEST_CASE("a TIMER is looked at in every millisecond") {
  // 1 s at first, since the start; back to 0 in the step behind the touch.
  const std::vector<std::pair<bool, const char*>> cases = {
      {true, "EXPECT THAT quiet = 1s"},
      {false, "EXPECT THAT quiet < 1s"},
      {true, "EXPECT THAT quiet < 10ms WITHIN 5ms"},
      {true, "EXPECT THAT quiet >= 2s WITHIN 2s"},
      {false, "EXPECT THAT quiet > 2s WITHIN 2s"},
      {true, "EXPECT THAT quiet > 2s WITHIN 2001ms"},
      {true, "WAIT 3s\n  EXPECT THAT quiet IS BETWEEN 2s AND touches * 3s"},
      {true, "WAIT 2s\n  EXPECT THAT quiet = 2s AND NOT quiet <> 2s"},
      {true, "EXPECT MOVE right_arm TO (quiet / 1s * 20deg) WITHIN 6s"},
      {false, "EXPECT MOVE right_arm TO (quiet / 1s * 21deg) WITHIN 6s"},
  };
  std::string tests =
      "TIMER quiet\nWHEN touch LEVEL > 3 DO\n  RESTART quiet\nEND\n"
      "WHEN quiet > 5s DO\n  MOVE right_arm TO (quiet / 1s * 20deg)\nEND\n";
  for (const auto& [met, steps] : cases)
    tests += touched("a TIMER", steps);
  const TestFolder robot(tests);
  const Outcome outcome = test::rsc({"test", robot.program, "--format", "json"});
  CAPTURE(outcome.err);
  const json report = json::parse(outcome.out);
  REQUIRE(report.at("tests").size() == cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    INFO(cases[i].second);
    CHECK(report.at("tests").at(i).at("ok") == cases[i].first);
  }
}

TEST_CASE("tests that pass are one line each, and exit 0") {
  const TestFolder robot(touched("it moves", "EXPECT MOVE arms WITHIN 20ms") +
                         touched("and again, from the start", "EXPECT THAT touches < 2 WITHIN 1s"));
  const Outcome outcome = test::rsc({"test", robot.program});
  CAPTURE(outcome.err);
  CHECK(outcome.exit == 0);
  CHECK(outcome.out == "ok      it moves\nok      and again, from the start\n2 passed, 0 failed\n");
}

TEST_CASE("a failing step is shown with what happened around it, and exit 1") {
  const TestFolder robot(touched("it bows low", "EXPECT MOVE arms TO 80deg WITHIN 1s") +
                         touched("it moves", "EXPECT MOVE arms WITHIN 20ms"));
  const Outcome outcome = test::rsc({"test", robot.program});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.out,
             Contains("FAILED  it bows low\n") &&
                 Contains("robot.rsl:29:3\n 29 |   EXPECT MOVE arms TO 80deg WITHIN 1s\n"
                          "    |   ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\n") &&
                 Contains("no `MOVE` for left_arm came from 1.000 s to 2.000 s; at 1.000 s it "
                          "was left_arm MOVE QUICKLY TO 90") &&
                 Contains("1.000 s  touch LEVEL = 5\n") &&
                 Contains("1.000 s  left_arm MOVE QUICKLY TO 90") &&
                 Contains("mood becomes scared\n") && Contains("log: touched with") &&
                 Contains("ok      it moves\n") && Contains("1 passed, 1 failed\n"));
}

TEST_CASE("what must not happen is said with its time") {
  const TestFolder robot(touched("still", "EXPECT NO MOVE left_arm WITHIN 1s"));
  CHECK_THAT(test::rsc({"test", robot.program}).out,
             Contains("    it came at 1.000 s: left_arm MOVE QUICKLY TO 90"));
}

TEST_CASE("a value that no sample of its sensor measures is pointed out") {
  const Folder folder;
  folder.write("robot.json", R"({
    "sensors": [{"name": "button", "type": "GPIO", "pin": 40, "device": "button",
                 "channels": {"POSITION": {"rate": "50Hz"}}}],
    "actuators": [{"name": "lamp", "type": "VIRTUAL"}]})");
  const auto tested = [&](const std::string& steps, const std::vector<std::string>& options = {}) {
    std::vector<std::string> arguments{
        "test", folder.write("robot.rsl",
                             "WHEN button IS pressed\nDO LOG \"x\"\nEND\n"
                             "TEST \"short\"\n  AT 0s button = \"released\"\n" +
                                 steps + "END\n")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return test::rsc(arguments);
  };
  const std::string unseen =
      "  AT 1005ms button = \"pressed\"\n  AT 1010ms button = \"released\"\n  EXPECT NO LOG \"x\" "
      "WITHIN "
      "1s\n";
  Outcome outcome = tested(unseen);
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out,
             Contains("ok      short\n  --> ") &&
                 Contains("6 |   AT 1005ms button = \"pressed\"\n") &&
                 Contains("warning: the robot never sees this: button is sampled every 20 ms"));
  CHECK_THAT(tested(unseen, {"-q"}).out, Contains("warning: the robot never sees this"));
  const json report = json::parse(tested(unseen, {"--format", "json"}).out);
  CHECK(report.at("tests").at(0).at("warnings").at(0).at("line") == 6);
  CHECK_THAT(tested("  AT 1005ms button = \"pressed\"\n  AT 1030ms button = \"released\"\n"
                    "  EXPECT NO LOG \"y\" WITHIN 1s\n")
                 .out,
             !Contains("warning"));
  CHECK_THAT(tested("  AT 1005ms button = \"pressed\"\n  AT 1005ms button = \"released\"\n"
                    "  EXPECT NO LOG \"x\" WITHIN 1s\n")
                 .out,
             !Contains("warning"));
  // Two values at one time, before the next sample.
  const std::string both = tested(
                               "  AT 1005ms button = \"pressed\"\n"
                               "  AT 1005ms button = \"released\"\n"
                               "  AT 1010ms button = \"released\"\n")
                               .out;
  CHECK_THAT(both, Contains("6 |   AT 1005ms button = \"pressed\"\n"));
  CHECK_THAT(both, Contains("7 |   AT 1005ms button = \"released\"\n"));
  // The test ends before the next sample.
  CHECK_THAT(tested("  AT 1005ms button = \"pressed\"\n").out, Contains("never sees this"));
}

TEST_CASE("what came outside of its window is said with its time") {
  const TestFolder robot(touched("late", "WAIT 100ms\n  EXPECT MOVE arms WITHIN 1s"));
  CHECK_THAT(test::rsc({"test", robot.program}).out,
             Contains("no `MOVE` for left_arm came from 1.100 s to 2.100 s; it was at 1.000 s\n"));
}

TEST_CASE("the nearest miss is named") {
  struct Miss {
    const char *step, *said;
  };
  for (const auto& [step, said] : std::vector<Miss>{
           {"EXPECT PLAY sound \"greeting.wav\" WITHIN 1s",
            "; PLAY at 1.000 s: warning.wav; expected greeting.wav\n"},
           {"EXPECT LOG \"touchd with\" WITHIN 1s",
            "it was not written from 1.000 s to 2.000 s; at 1.000 s it was: touched with 5; "
            "expected "
            "touchd with\n"},
           {"WAIT 1s\n  EXPECT LOG \"touched\"",
            "it was not written at 2.000 s; it was at 1.000 s\n"},
           {"EXPECT NO LOG \"touched\" WITHIN 1s", "it was written at 1.000 s: touched with 5\n"},
           {"EXPECT 2 TIMES MOVE arms WITHIN 1s",
            "`MOVE` came 1 time for left_arm from 1.000 s to 2.000 s, not 2\n"}}) {
    const TestFolder robot(touched("it", step));
    const Outcome outcome = test::rsc({"test", robot.program});
    CHECK(outcome.exit == 1);
    CHECK_THAT(outcome.out, Contains(said));
  }
}

TEST_CASE("SEED gives a TEST other random numbers") {
  const Folder folder;
  folder.write("robot.json", kRobot);
  const auto drawn_with = [&](const std::string& seed) {
    const std::string file = folder.write(
        "robot.rsl", "AT START DO\n  LOG \"drawn\", RANDOM(1, 1000000)\nEND\nTEST \"it\"\n" + seed +
                         "  EXPECT LOG \"nothing\" WITHIN 1s\nEND\n");
    const std::string out = test::rsc({"test", file}).out;
    return out.substr(out.find("drawn"), 13);
  };
  CHECK(drawn_with("  SEED 7\n") == drawn_with("  SEED 7\n"));
  CHECK(drawn_with("  SEED 7\n") != drawn_with("  SEED 8\n"));
}

TEST_CASE("a failure as JSON has the step, the window and the events") {
  const TestFolder robot(touched("it bows low", "EXPECT MOVE arms TO 80deg WITHIN 1s"));
  const Outcome outcome = test::rsc({"test", robot.program, "--format", "json"});
  CHECK(outcome.exit == 1);
  const json failed = json::parse(outcome.out).at("tests").at(0);
  CHECK(failed.at("test") == "it bows low");
  CHECK(failed.at("line") == 25);
  const json& failure = failed.at("failure");
  CHECK(failure.at("line") == 29);
  CHECK(failure.at("step") == "EXPECT MOVE arms TO 80deg WITHIN 1s");
  CHECK(failure.at("from_us") == 1'000'000);
  CHECK(failure.at("until_us") == 2'000'000);
  const auto is_command = [](const json& event) { return event.at("event") == "command"; };
  CHECK(std::ranges::count_if(failure.at("timeline"), is_command) == 3);
}

TEST_CASE("mistakes in a TEST are shown with their place, and no test runs") {
  struct Mistake {
    const char* steps;
    const char* message;
  };
  for (const auto& [steps, message] : std::vector<Mistake>{
           {"AT 2s toch LEVEL = 1", "E0501"},
           {"AT 2s touch LEVEL = 5N", "E0301"},
           {"AT 2s touch LEVEL = 50", "`touch LEVEL` cannot measure this: its range is 0 to 10"},
           {"AT 2s touch LEVEL = \"hard\"", "gives numbers, not words"},
           {"AT 2s touch LEVEL = TRUE", "is not true or false"},
           {"AT 2s button = 1", "gives words, not numbers"},
           {"AT 2s button = \"presed\"", "did you mean `pressed`?"},
           {"AT 500ms touch LEVEL = 1", "this time has already passed"},
           {"WAIT 2weeks", "E0303"},
           {"WAIT 90min", "this TEST would take 5400s; the limit is an hour, 3600s"},
           {"EXPECT MOVE leg WITHIN 1s", "E0501"},
           {"EXPECT MOVE arms TO 3N WITHIN 1s", "E0301"},
           {"EXPECT MOVE arms", "does not say how long it waits"},
           {"EXPECT NO MOVE arms", "does not say how long it waits"},
           {"EXPECT 2 TIMES STOPPED arms WITHIN 1s", "cannot be counted"},
           {"EXPECT 2s TIMES MOVE arms WITHIN 1s", "a whole number without a unit"},
           {"EXPECT 99999999999 TIMES MOVE arms WITHIN 1s", "a whole number from 0"},
           {"EXPECT LOG touched WITHIN 1s", "E0001"},
           {"SEED 1.5", "a whole number without a unit"},
           {"SEED 99999999999", "a whole number from 1"},
           {"SEED 0", "a whole number from 1"},
           {"EXPECT STOPPED WITHIN 1s", "needs one actuator or group"},
           {"EXPECT THAT touch LEVEL WITHIN 1s", "E0302"},
           {"EXPECT THAT mood IS angry", "`mood` is never `angry`"},
           {"EXPECT THAT mood BECOMES scared WITHIN 1s", "can test only one moment"}}) {
    const TestFolder robot(touched("wrong", steps));
    const Outcome outcome = test::rsc({"test", robot.program});
    CAPTURE(steps, outcome.err, outcome.out);
    CHECK(outcome.exit == 1);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, Contains(message) && Contains("robot.rsl:29:"));
    CHECK(test::rsc({"check", robot.program}).exit == 1);
  }
}

TEST_CASE("a program without tests says so") {
  const TestFolder robot("");
  const Outcome outcome = test::rsc({"test", robot.program});
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.err, Contains("there is no TEST in it"));
  CHECK(outcome.out == "0 passed, 0 failed\n");
}

// A reading may come in the millisecond in which the wait has looked, and after that.
TEST_CASE("a WAIT UNTIL and a FOLLOW see a reading, in whichever millisecond they begin") {
  const Folder folder;
  folder.write("robot.json", R"({
    "sensors": [
      {"name": "sonar", "type": "GPIO", "trigger": 3, "echo": 40, "device": "hc-sr04"},
      {"name": "go", "type": "VIRTUAL", "channels": {"ON": {"truth": true}}}],
    "actuators": [{"name": "head", "type": "PWM", "pin": 10, "device": "servo"}]})");
  std::string program =
      "BEHAVIOR waits PRIORITY 20\n"
      "  WHEN go\n"
      "  DO\n"
      "    WAIT UNTIL sonar DISTANCE < 80cm WITHIN 3s\n"
      "    LOG \"there\"\n"
      "  END\n"
      "END\n"
      "BEHAVIOR looks PRIORITY 10\n"
      "  WHILE go\n"
      "  DO FOLLOW head TO (sonar DISTANCE / 1cm * 1deg)\n"
      "  END\n"
      "END\n";
  for (int at = 1000; at < 1070; ++at) {
    program += "TEST \"at " + std::to_string(at) + "\"\n  AT 1s sonar DISTANCE = 70cm\n  AT " +
               std::to_string(at) +
               "ms go = \"yes\"\n"
               "  EXPECT LOG \"there\" WITHIN 70ms\n"
               "  EXPECT FOLLOW head TO 70deg WITHIN 70ms\nEND\n";
  }
  const Outcome outcome = test::rsc({"test", folder.write("robot.rsl", program)});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("70 passed, 0 failed"));
}

// Its samples come in the milliseconds of the window's, behind what is due in them by time.
TEST_CASE(
    "a single wrong reading does nothing behind SMOOTH, however many readings that looks at") {
  const Folder folder;
  folder.write("robot.json", R"({
    "sensors": [{"name": "sonar", "type": "GPIO", "trigger": 3, "echo": 40, "device": "hc-sr04"}],
    "actuators": [{"name": "lamp", "type": "VIRTUAL"}]})");
  for (const std::string over : {"200ms", "250ms", "300ms", "350ms", "400ms"}) {
    std::string program =
        "CHECK nearness OF sonar DISTANCE\n  near BELOW 80cm\n  away OTHERWISE\n"
        "  SMOOTH OVER " +
        over + "\nEND\nWHEN nearness IS near\nDO LOG \"near\"\nEND\n";
    for (const std::string at : {"1000", "1020", "1040", "1060"}) {
      program += "TEST \"at " + at + "\"\n  AT 0s sonar DISTANCE = 200cm\n  AT " + at +
                 "ms sonar DISTANCE = 20cm\n  EXPECT NO LOG \"near\" WITHIN 2s\n  AT " +
                 std::to_string(std::stoi(at) + 60) + "ms sonar DISTANCE = 200cm\nEND\n";
    }
    const Outcome outcome = test::rsc({"test", folder.write("robot.rsl", program)});
    CAPTURE(over, outcome.out, outcome.err);
    CHECK(outcome.exit == 0);
    CHECK_THAT(outcome.out, Contains("4 passed, 0 failed"));
  }
}

TEST_CASE("run shows what power a motor is given where the program says more than its limit") {
  const Folder folder;
  folder.write("robot.json", R"({
    "sensors": [{"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}}],
    "actuators": [{"name": "wheel", "type": "PWM", "pins": [3, 4], "device": "motor", "limits": {"SPEED": "40%"}},
                  {"name": "shown", "type": "VIRTUAL", "device": "motor"}]})");
  const std::string program = folder.write(
      "robot.rsl",
      "LIMIT shown SPEED TO 30%\nWHEN touch LEVEL > 3\nDO\n  RUN wheel TO (touch LEVEL * -10%)\n"
      "  RUN shown TO (touch LEVEL * 10%)\nEND\n");
  const std::string scenario = folder.write("visit.json", R"({"duration": "2s", "stimuli": [
      {"at": "1s", "sensor": "touch", "value": 9}]})");
  const Outcome outcome = test::rsc({"run", program, "--scenario", scenario, "--all"});
  CAPTURE(outcome.err);
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("wheel RUN TO -40%\n") && Contains("shown RUN TO 30%\n"));
}

TEST_CASE("a SAFETY rule that trips is named, also one of a module and a LIMIT that is one") {
  const Folder folder;
  folder.write("robot.json", R"({
    "sensors": [{"name": "arm", "type": "VIRTUAL", "channels": {"FORCE": {"unit": "N", "range": [0, 50]}}}],
    "actuators": [{"name": "arm", "type": "PWM", "pin": 10, "device": "servo"}]})");
  folder.write("hands.rsl",
               "safety pinched\n  WHEN arm FORCE > 20N\n  DO STOP arm\n"
               "  RESUME WHEN arm FORCE < 5N\nEND\n");
  const std::string program = folder.write(
      "robot.rsl", "USE \"hands.rsl\"\n\nLIMIT arm FORCE TO 15N\nAT START DO LOG 1 END\n");
  const std::string scenario = folder.write("visit.json", R"({"duration": "1s", "stimuli": [
      {"at": "0s", "sensor": "arm", "value": "1N"}, {"at": "0.5s", "sensor": "arm", "value": "30N"}]})");
  const Outcome outcome = test::rsc({"run", program, "--scenario", scenario});
  CAPTURE(outcome.err);
  CHECK_THAT(outcome.out, Contains("SAFETY: safety rule LIMIT arm at line 3 trips\n") &&
                              Contains("hands.rsl:1 trips\n") &&
                              Contains("SAFETY: safety rule pinched at "));
}

TEST_CASE("run takes the words of a channel, and shows what safety does in words") {
  const TestFolder robot("");
  const std::string scenario = robot.write("visit.json", R"({"duration": "4s", "stimuli": [
      {"at": "0s", "sensor": "button", "value": "released"},
      {"at": "1s", "sensor": "button", "value": "PRESSED"},
      {"at": "2s", "sensor": "button", "value": "released"},
      {"at": "3s", "sensor": "waved", "value": true}]})");
  const Outcome outcome = test::rsc({"run", robot.program, "--scenario", scenario, "--all"});
  CAPTURE(outcome.err);
  CHECK(outcome.exit == 0);
  for (const char* const line :
       {"1.000 s  button POSITION = pressed\n", "SAFETY: safety rule stop_button at line 4 trips\n",
        "left_arm is halted\n", "ALERT: Stopped by a person\n",
        "SAFETY: safety rule stop_button at line 4 lets go\n", "right_arm may move again\n",
        "left_arm MOVE SLOWLY TO 20"}) {
    CHECK_THAT(outcome.out, Contains(line));
  }
  const std::string wrong = robot.write("wrong.json", R"({"stimuli": [
      {"at": "0s", "sensor": "button", "value": "presed"}]})");
  CHECK_THAT(test::rsc({"run", robot.program, "--scenario", wrong}).err,
             Contains("wrong.json:2: ") && Contains("did you mean `pressed`?"));
}

TEST_CASE("explain: a program, a code, a wrong program, a code that does not exist") {
  const TestFolder robot("");
  Outcome outcome = test::rsc({"explain", robot.program});
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("As soon as touch LEVEL becomes more than 3 (line 13):") &&
                              Contains("It uses left_arm, right_arm and sound."));
  outcome = test::rsc({"explain", "w0203"});
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("W0203 (note): WHEN/ELSE acts at start"));
  CHECK(json::parse(test::rsc({"explain", "E0301", "--format", "json"}).out).at("code") == "E0301");
  CHECK(test::rsc({"explain", robot.write("wrong.rsl", "WHEN touch DO\n")}).exit == 1);
  outcome = test::rsc(
      {"explain", robot.write("unknown.rsl", "WHEN tuch LEVEL > 3 DO\n  LOG \"x\"\nEND\n")});
  CHECK(outcome.exit == 1);
  CHECK(outcome.out.empty());
  CHECK_THAT(outcome.err, Contains("E0501") && Contains("did you mean `touch`?"));
  CHECK(test::rsc({"explain", robot.program, "--config", robot.path("none.json")}).exit == 3);
  outcome = test::rsc({"explain", "E0300"});
  CHECK(outcome.exit == 2);
  CHECK_THAT(outcome.err, Contains("there is no diagnostic E0300"));
}

TEST_CASE("explain says at its end how fast the LIMITs of the program let a part move") {
  const Folder folder;
  (void)folder.write("robot.json", R"({"actuators": [
    {"name": "left_arm", "type": "VIRTUAL", "device": "joint", "limits": {"SPEED": "20deg/s"}},
    {"name": "right_arm", "type": "VIRTUAL", "device": "joint"}],
    "groups": {"arms": ["left_arm", "right_arm"]}})");
  const std::string program = folder.write("robot.rsl",
                                           "LET slow = 40deg/s\nLIMIT arms SPEED TO 60deg/s\n"
                                           "LIMIT right_arm SPEED TO slow\n"
                                           "AT START DO\n  LOG \"a\"\nEND\n");
  const Outcome outcome = test::rsc({"explain", program});
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("  left_arm: It goes no faster than 20deg/s. In a halt") &&
                              Contains("  right_arm: It goes no faster than 40deg/s. In a halt"));
}

TEST_CASE("explain takes a code without its zero or its letter") {
  for (const char* const word : {"E301", "0301", "e301", "301"})
    CHECK(test::rsc({"explain", word}).out == test::rsc({"explain", "E0301"}).out);
  const auto said = [](const char* word) { return test::rsc({"explain", word}).err; };
  CHECK_THAT(said("0203"), Contains("no diagnostic 0203; did you mean `E0203` or `W0203`?"));
  CHECK_THAT(said("99999"), Contains("no diagnostic 99999; a code is a letter and four digits"));
}

TEST_CASE("explain says what is wrong with the configuration, as check does") {
  const Folder folder;
  const std::string program = folder.write("robot.rsl", "AT START DO\n  SAY \"Hi\"\nEND\n");
  const auto as_check = [&](int exit, const char* text) {
    const Outcome outcome = test::rsc({"explain", program});
    CHECK(outcome.exit == exit);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, Contains(text));
    CHECK(outcome.err == test::rsc({"check", program}).err);
  };
  as_check(3, "no configuration for ");
  folder.write("robot.json", R"({"duration": "1s", "stimuli": []})");
  as_check(1, "is a scenario, but its name makes it the configuration of");
}

// A condition of an experiment may be silence, beside the texts of a LIST.
TEST_CASE("an empty text is said in no time, and a TEST tells it from other texts") {
  const Folder folder;
  folder.write("robot.json", kRobot);
  const std::string program = "EVERY 2s DO\n  SAY \"\"\n  SAY \"One two\"\n  SAY \" \"\nEND\n";
  const Outcome ran = test::rsc({"run", folder.write("robot.rsl", program), "--duration", "3s",
                                 "--trace", folder.path("t.jsonl")});
  CAPTURE(ran.out, ran.err);
  CHECK(ran.exit == 0);
  CHECK_THAT(ran.out, Contains("2.000 s  sound SAY \"\"\n   2.000 s  sound SAY One two\n") &&
                          Contains("2.700 s  sound SAY  \n"));
  CHECK_THAT(folder.read("t.jsonl"),
             Contains(R"("verb":"SAY","word":""})") && Contains(R"("word":"One two"})"));
  const auto tested = [&](const std::string& expected) {
    return test::rsc({"test",
                      folder.write("t.rsl", program + "TEST \"silence\"\n" + expected + "END\n"),
                      "--config", folder.path("robot.json")});
  };
  CHECK(tested("  EXPECT SAY \"\" WITHIN 2s\n").exit == 0);
  CHECK(tested("  EXPECT NO SAY \"\" WITHIN 2s\n").exit == 1);
  const Outcome failed = tested("  EXPECT SAY \"Two\" WITHIN 2s\n");
  CHECK(failed.exit == 1);
  CHECK_THAT(failed.out, Contains("SAY at 2.000 s: \"\"; expected Two"));
}

TEST_CASE("a TEST tells upper from lower case in a text, not in a word of a device") {
  const TestFolder robot("");
  const std::string program =
      "EVERY 2s DO\n  SAY \"Hello Ann\"\n  MOVE left_arm TO 20deg SLOWLY\nEND\n";
  const auto tested = [&](const std::string& expected) {
    return test::rsc(
        {"test", robot.write("t.rsl", program + "TEST \"case\"\n" + expected + "END\n")});
  };
  CHECK(tested("  EXPECT SAY \"Hello Ann\" WITHIN 2s\n").exit == 0);
  CHECK(tested("  EXPECT NO SAY \"hello ann\" WITHIN 2s\n").exit == 0);
  CHECK(tested("  EXPECT MOVE left_arm slowly WITHIN 2s\n").exit == 0);
  const Outcome failed = tested("  EXPECT SAY \"hello Ann\" WITHIN 2s\n");
  CHECK(failed.exit == 1);
  CHECK_THAT(failed.out, Contains("SAY at 2.000 s: Hello Ann; expected hello Ann"));
}

// Half a degree or a radian further on would be another whole number.
TEST_CASE("ROUND makes whole what robot.json measures in F and rad, at every level of optimising") {
  const Folder folder;
  folder.write("robot.json", R"({"sensors": [{"name": "temp", "type": "VIRTUAL", "channels": {
      "T": {"unit": "F", "range": [-40, 200]}, "A": {"unit": "rad", "range": [-7, 7]}}}],
      "actuators": [{"name": "arm", "type": "VIRTUAL"}]})");
  const std::string program =
      folder.write("robot.rsl",
                   "WHEN temp T < 0F\nDO LOG \"at\", ROUND(temp T)\nEND\n"
                   "WHEN temp T > 0F\nDO LOG \"at\", ROUND(temp T), ROUND(temp A)\nEND\n"
                   "WHEN ROUND(temp T) = 99F AND ROUND(temp A) = 2rad\nDO LOG \"yes\"\nEND\n");
  for (const char* const level : {"-O0", "-O1"}) {
    const auto logged = [&](const std::string& degrees, const std::string& angle) {
      const std::string visit = folder.write("visit.json", R"({"duration": "2s", "stimuli": [
        {"at": "1s", "sensor": "temp", "channel": "A", "value": ")" +
                                                               angle + R"("},
        {"at": "1s", "sensor": "temp", "channel": "T", "value": ")" +
                                                               degrees + R"("}]})");
      const Outcome ran = test::rsc({"run", program, "--scenario", visit, level});
      CAPTURE(ran.err);
      CHECK(ran.exit == 0);
      return ran.out;
    };
    CAPTURE(level);
    const std::string warm = logged("98.6F", "90deg");
    CHECK_THAT(warm, Contains("log: at 99F 2rad\n") && Contains("log: yes"));
    CHECK_THAT(logged("98.4F", "-1.6rad"),
               Contains("log: at 98F -2rad\n") && !Contains("log: yes"));
    CHECK_THAT(logged("0.6F", "-0.4rad"), Contains("log: at 1F 0rad\n"));
    CHECK_THAT(logged("-3.6F", "1rad"), Contains("log: at -4F\n"));
  }
}

TEST_CASE("a difference of temperatures in F has no 32 in it, at every level of optimising") {
  const Folder folder;
  folder.write("robot.json", R"({"sensors": [
      {"name": "inside", "type": "VIRTUAL", "channels": {"T": {"unit": "F", "range": [0, 120]}}},
      {"name": "outside", "type": "VIRTUAL", "channels": {"T": {"unit": "F", "range": [0, 120]}}}],
      "actuators": [{"name": "sound", "type": "VIRTUAL", "device": "speaker"}]})");
  const std::string program = folder.write(
      "robot.rsl",
      "REMEMBER z = 50F\nWHEN inside > outside + 5F\nDO\n"
      "  SAY \"it is\", inside, \"that is\", inside - outside, \"more\"\n  RAISE z BY 9F\n"
      "  LOG z, outside + 5, outside + 5F, inside + (outside - inside) / 2, ABS(outside - inside) "
      "* 2\n"
      "END\nWHEN ABS(inside - outside) > 10F\nDO LOG \"never\"\nEND\n"
      "TEST \"nine\"\n  AT 0s outside = 68F\n  AT 0s inside = 77F\n"
      "  EXPECT SAY \"it is 77F that is 9F more\" WITHIN 0ms\n"
      "  EXPECT LOG \"59F 73F 73F 72.5F 18F\" WITHIN 0ms\n  EXPECT NO LOG \"never\" WITHIN 1s\n"
      "  EXPECT THAT inside - outside = 9F\n  EXPECT THAT inside - outside > 6F\nEND\n");
  for (const char* const level : {"-O0", "-O1"}) {
    const Outcome tested = test::rsc({"test", program, level});
    CAPTURE(level, tested.out, tested.err);
    CHECK(tested.exit == 0);
  }
}

TEST_CASE("an ITEM with an unknown number takes nothing, and the trace says so") {
  const TestFolder robot("");
  const std::string program = robot.write(
      "items.rsl",
      "LIST w: \"a\", \"b\"\nDEFINE tell WITH what\n  SAY what\nEND\n"
      "WHEN waved\nDO\n  LOG \"item\", ITEM touch LEVEL OF w\n  tell WITH ITEM touch LEVEL OF w\n"
      "  LOG \"done\"\nEND\n");
  const std::string scenario = robot.write("visit.json", R"({"duration": "3s", "stimuli": [
      {"at": "1s", "sensor": "waved", "value": true}, {"at": "1500ms", "sensor": "waved", "value": false},
      {"at": "2s", "sensor": "touch", "channel": "LEVEL", "value": 2},
      {"at": "2500ms", "sensor": "waved", "value": true}]})");
  for (const char* const level : {"-O0", "-O1"}) {
    const Outcome ran = test::rsc({"run", program, "--scenario", scenario, level});
    CAPTURE(level, ran.out, ran.err);
    const std::string nothing = "1.000 s  log: there is no ITEM unknown OF w, which has 2\n";
    CHECK_THAT(ran.out, Contains(nothing + "   " + nothing + "   1.000 s  log: done\n"));
    CHECK_THAT(ran.out, Contains("2.500 s  log: item b\n   2.500 s  log: done\n"
                                 "   2.500 s  sound SAY b\n"));
  }
}
