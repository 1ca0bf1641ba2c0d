// Scenarios: what they mean, and a message with file and line for each that is wrong.
#include "rsc/trace/scenario.hpp"

#include <catch2/catch.hpp>

#include "rsc/failure.hpp"
#include "tests/rsc/image.hpp"
#include "tests/rsc/process.hpp"

using namespace robosync;

namespace {

tool::Scenario read(const std::string& text) {
  static const tool::Program program = test::compile();
  const test::Folder folder;
  return tool::read_scenario(folder.write("visit.json", text), program);
}

// Of the file called `name`.
template <typename Body>
std::string mistake_in(const std::string& name, Body body) {
  try {
    body();
  } catch (const tool::Failure& failure) {
    CHECK(failure.exit() == tool::Exit::program);
    const std::string message = failure.what();
    return message.substr(std::min(message.size(), message.find(name)));
  }
  return "none";
}

std::string mistake(const std::string& text) {
  return mistake_in("visit.json", [&] { read(text); });
}

// With a recording beside it.
tool::Scenario read_recording(const std::string& csv,
                              const std::string& stimulus = R"({"csv": "desk.csv"})") {
  static const tool::Program program = test::compile();
  const test::Folder folder;
  folder.write("desk.csv", csv);
  return tool::read_scenario(folder.write("visit.json", "{\"stimuli\": [\n" + stimulus + "]}"),
                             program);
}

std::string recording_mistake(const std::string& csv) {
  return mistake_in("desk.csv", [&] { read_recording(csv); });
}

}  // namespace

TEST_CASE("readings at times, in any order of the file") {
  const tool::Scenario scenario = read(R"({"duration": "3s", "stimuli": [
    {"at": "2s", "sensor": "touch", "channel": "LEVEL", "value": 2},
    {"at": "500ms", "sensor": "PROXIMITY", "channel": "distance", "value": "20cm"},
    {"at": "1s", "sensor": "touch", "value": 1.5}]})");
  CHECK(scenario.duration_us == 3'000'000u);
  REQUIRE(scenario.stimuli.size() == 3);
  CHECK(scenario.stimuli[0].at_us == 500'000);
  CHECK(scenario.stimuli[0].channel == 1);
  CHECK(scenario.stimuli[0].value == 200'000);
  CHECK(scenario.stimuli[1].value == 1500);
  CHECK(scenario.stimuli[2].at_us == 2'000'000);
  CHECK(scenario.stimuli[2].channel == 0);
}

TEST_CASE("a ramp is a straight line of readings from the first value to the last") {
  const tool::Scenario scenario = read(R"({"stimuli": [
    {"from": "1s", "to": "2s", "sensor": "proximity", "channel": "DISTANCE",
     "ramp": ["120cm", "20cm"]}]})");
  CHECK_FALSE(scenario.duration_us);
  REQUIRE(scenario.stimuli.size() > 10);
  CHECK(scenario.stimuli.front().at_us == 1'000'000);
  CHECK(scenario.stimuli.front().value == 1'200'000);
  CHECK(scenario.stimuli.back().at_us == 2'000'000);
  CHECK(scenario.stimuli.back().value == 200'000);
  for (const tool::Stimulus& stimulus : scenario.stimuli) {
    CHECK(stimulus.value ==
          1'200'000 - static_cast<vm::Value>(stimulus.at_us - 1'000'000));  // 1 mm a millisecond
  }
}

TEST_CASE("a ramp over all values does not overflow, and one of too many readings is refused") {
  const tool::Scenario scenario = read(R"({"stimuli": [
    {"from": "0s", "to": "10000s", "sensor": "touch", "ramp": [-2147483.647, 2147483.647]}]})");
  CHECK(scenario.stimuli.front().value == vm::kValueMin);
  CHECK(scenario.stimuli.back().value == vm::kValueMax);
  CHECK(std::ranges::is_sorted(scenario.stimuli, {}, &tool::Stimulus::value));
  CHECK_THAT(mistake(R"({"stimuli": [
    {"from": "0s", "to": "2000000s", "sensor": "touch", "ramp": [0, 1]}]})"),
             Catch::StartsWith("visit.json:2: ") && Catch::Contains("million"));
}

TEST_CASE("a wrong scenario gets one message with its line") {
  using Catch::Contains;
  using Catch::StartsWith;
  CHECK_THAT(
      mistake("{\"stimuli\": [\n{]}"),
      StartsWith("visit.json:2: an object ends with `}`, not with `]`; line 2: opened here"));
  CHECK_THAT(mistake("[]"), StartsWith("visit.json:1: a scenario is an object"));
  CHECK_THAT(
      mistake("{\n\"durration\": \"3s\"}"),
      StartsWith("visit.json:2: there is no key `durration` here; did you mean `duration`?"));
  CHECK_THAT(mistake("{\n\n\"duration\": 3}"), StartsWith("visit.json:3: a time is a string"));
  CHECK_THAT(mistake("{\"duration\": \"1s\", \"duration\": \"2s\"}"),
             Contains("the key `duration` is given twice"));
  CHECK_THAT(mistake("{\"stimuli\": 3}"), Contains("not an array"));

  const auto stimulus = [](const std::string& text) {
    return mistake("{\"stimuli\": [\n  {\"at\": \"1s\", \"sensor\": \"touch\", \"value\": 1},\n  " +
                   text + "\n]}");
  };
  CHECK_THAT(stimulus("7"), StartsWith("visit.json:3: a stimulus is an object"));
  CHECK_THAT(stimulus("{\"at\": \"1s\", \"sensor\": \"tuoch\", \"value\": 1}"),
             StartsWith("visit.json:3: there is no sensor `tuoch`; did you mean `touch`?"));
  CHECK_THAT(
      stimulus("{\"at\": \"1s\", \"sensor\": \"touch\",\n\"channel\": \"LEVL\", \"value\": 1}"),
      StartsWith("visit.json:4: touch has no channel `LEVL`; did you mean `LEVEL`?"));
  CHECK_THAT(stimulus("{\"at\": \"1s\", \"sensor\": \"proximity\", \"value\": 1}"),
             Contains("several channels") && Contains("DISTANCE, NOISE"));
  CHECK_THAT(stimulus("{\"sensor\": \"touch\", \"value\": 1}"), Contains("no `at`"));
  CHECK_THAT(stimulus("{\"at\": \"1s\", \"sensor\": \"touch\"}"), Contains("no `value`"));
  CHECK_THAT(stimulus("{\"at\": \"1s\", \"sensor\": 5, \"value\": 1}"), Contains("not a string"));
  CHECK_THAT(stimulus("{\"at\": \"1s\", \"sensor\": \"touch\",\n\n\"value\": true}"),
             StartsWith("visit.json:5: a reading is a number"));
  CHECK_THAT(stimulus("{\"at\": \"soon\", \"sensor\": \"touch\", \"value\": 1}"),
             Contains("`soon` is not a number"));
  CHECK_THAT(stimulus("{\"at\": \"1s\", \"sensor\": \"proximity\", \"channel\": \"NOISE\", "
                      "\"value\": 20}"),
             Contains("write it as 20dB"));
  CHECK_THAT(
      stimulus("{\"from\": \"2s\", \"to\": \"1s\", \"sensor\": \"touch\", \"ramp\": [1, 2]}"),
      Contains("ends before it starts"));
  CHECK_THAT(stimulus("{\"from\": \"1s\", \"to\": \"2s\", \"sensor\": \"touch\", \"ramp\": [1]}"),
             Contains("`ramp` is"));
  CHECK_THAT(stimulus("{\"at\": \"1s\", \"sensor\": \"touch\", \"valeu\": 1}"),
             Contains("did you mean `value`?"));
}

TEST_CASE("text that is not JSON is explained as in robot.json") {
  using Catch::StartsWith;
  CHECK_THAT(mistake("{\"stimuli\": [\n{},\n]}"),
             StartsWith("visit.json:2: there is an extra comma before `]`"));
  CHECK_THAT(mistake("{\n'stimuli': []}"), StartsWith("visit.json:2: JSON strings need double"));
  CHECK_THAT(mistake("{\"stimuli\": [\n{\"at\": 1s}]}"),
             StartsWith("visit.json:2: a number with a unit needs double quotes in JSON; write "
                        "`\"1s\"`"));
  CHECK_THAT(mistake("{\"stimuli\": [\n{}\n"), StartsWith("visit.json:3: the file ends too early; "
                                                          "line 1: this is not closed with `]`"));
  CHECK_THAT(mistake(""), StartsWith("visit.json:1: there is no JSON in this file"));
}

TEST_CASE("a key that a stimulus does not have is answered with those that it has") {
  using Catch::Contains;
  const auto stimulus = [](const std::string& keys) {
    return mistake("{\"stimuli\": [{\"sensor\": \"touch\", " + keys + "}]}");
  };
  CHECK_THAT(stimulus(R"("time": "1s", "value": 1)"),
             Contains("there is no key `time` here; did you mean `at`?"));
  CHECK_THAT(stimulus(R"("from": "1s", "to": "2s", "value": [1, 2])"),
             Contains("there is no key `value` here; did you mean `ramp`?"));
  CHECK_THAT(stimulus(R"("when": "1s", "value": 1)"),
             Contains("there is no key `when` here; known: at, sensor, channel, value"));
}

TEST_CASE("a misspelt name is told from one that the program does not read") {
  using Catch::EndsWith;
  const tool::Program program =
      test::compile("WHEN touch LEVEL > 3 DO\n  MOVE left_arm TO 0deg\nEND\n");
  const test::Folder folder;
  const auto of = [&](const std::string& keys) {
    return mistake_in("visit.json", [&] {
      (void)tool::read_scenario(
          folder.write("visit.json", "{\"stimuli\": [{\"at\": \"1s\", " + keys + "}]}"), program);
    });
  };
  CHECK_THAT(of(R"("sensor": "proximity", "channel": "NOSE", "value": "70dB")"),
             EndsWith(":1: proximity has no channel `NOSE`; did you mean `NOISE`?"));
  CHECK_THAT(of(R"("sensor": "proximty", "value": "9cm")"),
             EndsWith(":1: there is no sensor `proximty`; did you mean `proximity`?"));
  CHECK_THAT(of(R"("sensor": "door", "value": 1)"),
             EndsWith(":1: there is no sensor `door`; known: proximity, touch"));
  CHECK_THAT(
      of(R"("sensor": "proximity", "channel": "DISTANCE", "value": "9s")"),
      EndsWith(":1: `9s` is a time, but this is a distance; it takes a number with mm, cm or m"));
  CHECK(of(R"("sensor": "proximity", "channel": "DISTANCE", "value": "9mm")") == "none");
}

TEST_CASE("a sensor of which the program reads only one channel still has several") {
  using Catch::Contains;
  const tool::Program program =
      test::compile("WHEN proximity NOISE > 60dB DO\n  MOVE left_arm TO 0deg\nEND\n");
  const test::Folder folder;
  CHECK_THAT(mistake_in("visit.json",
                        [&] {
                          (void)tool::read_scenario(folder.write("visit.json", R"({"stimuli": [
    {"at": "1s", "sensor": "proximity", "value": "70dB"}]})"),
                                                    program);
                        }),
             Contains("`proximity` has several channels") && Contains("DISTANCE, NOISE"));
}

TEST_CASE("a name that is like no other is answered with those that there are") {
  using Catch::Contains;
  CHECK_THAT(mistake("{\"stimuli\": [{\"at\": \"1s\", \"sensor\": \"door\", \"value\": 1}]}"),
             Contains("there is no sensor `door`; known: proximity, touch"));
}

TEST_CASE("braces, commas and quotes in strings do not confuse the lines") {
  CHECK(mistake("{\"stimuli\": [\n{\"at\": \"1s\", \"sensor\": \"}],\\\"{\", \"value\": 1},\n"
                "{\"at\": 1}]}")
            .starts_with("visit.json:2: there is no sensor"));
}

TEST_CASE("a recording in CSV: a column of times, and one for each channel") {
  const tool::Scenario scenario = read_recording(
      "time (s),touch.LEVEL,\"proximity DISTANCE\",proximity.NOISE (dB)\r\n"
      "0,3,120,40\r\n"
      "0.5,,1.1m,41.5\r\n"
      "\r\n"
      "1500ms,4,,\r\n");
  REQUIRE(scenario.stimuli.size() == 6);
  CHECK(scenario.stimuli[0].at_us == 0);
  CHECK(scenario.stimuli[0].value == 3'000);
  CHECK(scenario.stimuli[1].value == 1'200'000);  // robot.json says cm
  CHECK(scenario.stimuli[2].value == 40'000);
  CHECK(scenario.stimuli[3].at_us == 500'000);
  CHECK(scenario.stimuli[3].value == 1'100'000);
  CHECK(scenario.stimuli[4].value == 41'500);
  CHECK(scenario.stimuli[5].at_us == 1'500'000);
  CHECK(scenario.stimuli[5].channel == scenario.stimuli[0].channel);
  CHECK(scenario.notes.empty());
}

TEST_CASE("a recording may have numbers with an exponent, as pandas and R write them") {
  const tool::Scenario scenario =
      read_recording("time (s),proximity.DISTANCE (m)\n1e-03,5e-01\n0.30000000000000004,1E0\n");
  REQUIRE(scenario.stimuli.size() == 2);
  CHECK(scenario.stimuli[0].at_us == 1'000);
  CHECK(scenario.stimuli[0].value == 500'000);
  CHECK(scenario.stimuli[1].at_us == 300'000);
}

TEST_CASE("a recording of one sensor, that begins later, from a German spreadsheet") {
  const tool::Scenario scenario =
      read_recording("\xEF\xBB\xBFtime;DISTANCE (mm)\n0ms;200\n50ms;210\n",
                     R"({"csv": "desk.csv", "sensor": "proximity", "at": "2s"})");
  REQUIRE(scenario.stimuli.size() == 2);
  CHECK(scenario.stimuli[1].at_us == 2'050'000);
  CHECK(scenario.stimuli[1].value == 210'000);
}

TEST_CASE("a wrong recording gets one message with its line") {
  using Catch::StartsWith;
  CHECK(recording_mistake("").starts_with("desk.csv:1: the file is empty"));
  CHECK(
      recording_mistake("touch.LEVEL\n3\n").starts_with("desk.csv:1: no column is called `time`"));
  CHECK(recording_mistake("time (s),touhc.LEVEL\n0,3\n")
            .starts_with("desk.csv:1: there is no sensor `touhc`; did you mean `touch`?"));
  CHECK(recording_mistake("time (s),touch.LEVEL\n0,3\n1,3,4\n")
            .starts_with("desk.csv:3: this row has 3 cells, and the first row names 2 columns"));
  CHECK(recording_mistake("time,touch.LEVEL\n0,3\n")
            .starts_with("desk.csv:2: `0` is a plain number"));
  CHECK(recording_mistake("time (s),touch.LEVEL\n0,3\n1,high\n")
            .starts_with("desk.csv:3: `high` is not a number"));
  CHECK(recording_mistake("time (s);touch.LEVEL\n0,5;3\n")
            .starts_with("desk.csv:2: `0,5` has a comma: write the decimal point as a point"));
  CHECK(recording_mistake("time (s),touch.LEVEL\n0,3\n-1,3\n")
            .starts_with("desk.csv:3: `-1s` is negative"));
  CHECK(recording_mistake("time (s),touch.LEVEL (cm)\n0,3\n")
            .starts_with("desk.csv:2: `3cm` is a distance"));
  CHECK(recording_mistake("time (s),touch.LEVEL\n0,\"3\n1,4\n").starts_with("desk.csv:3: a quote"));
  CHECK_THROWS_AS(read_recording("", R"({"csv": "none.csv"})"), tool::Failure);
}

TEST_CASE("readings out of range, and columns with one name, are notes") {
  using Catch::EndsWith;
  tool::Scenario scenario = read(R"({"stimuli": [
    {"at": "1s", "sensor": "touch", "value": 10},
    {"at": "2s", "sensor": "touch", "value": 500}, {"at": "3s", "sensor": "touch", "value": -1},
    {"at": "2s", "sensor": "proximity", "channel": "DISTANCE", "value": "20m"}]})");
  REQUIRE(scenario.notes.size() == 2);
  CHECK_THAT(scenario.notes[0],
             EndsWith("visit.json:3: note: 500 is out of the range of touch LEVEL, 0 to 10: the "
                      "robot reads 10"));
  CHECK_THAT(scenario.notes[1],
             EndsWith("visit.json:4: note: 2000cm is out of the range of "
                      "proximity DISTANCE, 2cm to 400cm: the robot reads 400cm"));
  scenario = read_recording("time (s),touch.LEVEL,touch LEVEL,time (s)\n0,1,2,0\n1,11,1,1\n");
  REQUIRE(scenario.notes.size() == 3);
  CHECK_THAT(scenario.notes[0], EndsWith("desk.csv:1: note: two columns are called `touch LEVEL`; "
                                         "the last one counts"));
  CHECK_THAT(scenario.notes[1], Catch::Contains("`time`"));
  CHECK_THAT(scenario.notes[2], Catch::Contains("desk.csv:3: note: 11 is out of"));
}

TEST_CASE("what the robot has and the program does not read is a note") {
  const test::Folder folder;
  const tool::Program program =
      test::compile("WHEN proximity NOISE > 60dB\nDO MOVE left_arm TO 9deg\nEND\n");
  const tool::Scenario scenario = tool::read_scenario(folder.write("visit.json", R"({"stimuli": [
    {"at": "1s", "sensor": "touch", "value": 3},
    {"at": "2s", "sensor": "touch", "value": 4},
    {"at": "2s", "sensor": "proximity", "channel": "DISTANCE", "value": "9cm"},
    {"at": "3s", "sensor": "proximity", "channel": "NOISE", "value": "70dB"}]})"),
                                                      program);
  REQUIRE(scenario.stimuli.size() == 1);
  REQUIRE(scenario.notes.size() == 2);
  CHECK_THAT(scenario.notes[0],
             Catch::Contains("visit.json:2: note: the program does not read touch,"));
  CHECK_THAT(scenario.notes[1],
             Catch::Contains("visit.json:4: note: the program does not read proximity DISTANCE,"));
}

TEST_CASE("a reading without a unit is offered the one of robot.json") {
  using Catch::Contains;
  const test::Folder folder;
  const std::string program =
      folder.write("robot.rsl", "WHEN near DISTANCE < 80cm\nDO LOG \"x\"\nEND\n");
  folder.write("robot.json", R"({"sensors": [{"name": "near", "type": "VIRTUAL", "channels":
      {"DISTANCE": {"unit": "cm", "range": [2, 400]}}}], "actuators": []})");
  const auto message = [&](const std::string& stimulus) {
    const std::string scenario =
        folder.write("visit.json", "{\"stimuli\": [{" + stimulus + ", \"sensor\": \"near\"}]}");
    return test::rsc({"run", program, "--scenario", scenario}).err;
  };
  CHECK_THAT(message(R"("at": "1s", "value": 20)"), Contains("; write it as 20cm\n"));
  CHECK_THAT(message(R"("from": "1s", "to": "2s", "ramp": ["10cm", "20"])"),
             Contains("; write it as 20cm\n"));
  CHECK_THAT(message(R"("at": "1s", "value": "20deg")"),
             Contains("; it takes a number with mm, cm or m\n"));
  CHECK_THAT(message(R"("at": "1m", "value": "20cm")"),
             Contains("; it takes a number with ms, s, min or h\n"));
}
