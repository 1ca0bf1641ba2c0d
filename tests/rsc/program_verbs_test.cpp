// check, compile, dump and run on real programs.
#include <algorithm>
#include <sstream>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "compiler/config/boards.hpp"
#include "tests/rsc/image.hpp"
#include "tests/rsc/process.hpp"

using namespace robosync;
using Catch::Contains;
using nlohmann::json;
using test::Folder;
using test::Outcome;
using test::RobotFolder;

namespace {

std::string wrong_program() {
  std::string text = test::kProgram;
  text.replace(text.find("left_arm"), 8, "left_amr");
  return text;
}

std::vector<json> json_lines(const std::string& text) {
  std::vector<json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    lines.push_back(json::parse(line));
  return lines;
}

}  // namespace

TEST_CASE("check: a right program, a wrong one, and both as JSON") {
  const RobotFolder robot;
  Outcome outcome = test::rsc({"check", robot.program});
  CAPTURE(outcome.err);
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("robot.rsl: 0 errors, 0 warnings, "));

  const std::string wrong = robot.write("wrong.rsl", wrong_program());
  outcome = test::rsc({"check", wrong});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("wrong.rsl:2:") && Contains("left_arm"));
  CHECK_THAT(outcome.out, Contains("wrong.rsl: 1 error, "));
  CHECK(outcome.err.find('\x1b') == std::string::npos);

  outcome = test::rsc({"check", robot.program, wrong, "--format", "json"});
  CHECK(outcome.exit == 1);
  CHECK(outcome.err.empty());
  const json report = json::parse(outcome.out);
  CHECK(report.at("errors") == 1);
  bool found = false;
  for (const json& diagnostic : report.at("diagnostics")) {
    if (diagnostic.at("level") != "error") continue;
    found = true;
    CHECK(diagnostic.at("labels").at(0).at("line") == 2);
    CHECK_THAT(diagnostic.at("labels").at(0).at("file").get<std::string>(), Contains("wrong.rsl"));
  }
  CHECK(found);
}

TEST_CASE("the configuration: --config, else STEM.json, else robot.json") {
  const Folder folder;
  const std::string program = folder.write("pet.rsl", test::kProgram);
  Outcome outcome = test::rsc({"check", program});
  CHECK(outcome.exit == 3);
  CHECK_THAT(outcome.err, Contains("pet.json") && Contains("robot.json") && Contains("--config"));

  folder.write("robot.json", test::kRobot);
  CHECK(test::rsc({"check", program}).exit == 0);
  folder.write("pet.json", "{");
  CHECK(test::rsc({"check", program}).exit == 1);
  CHECK(test::rsc({"check", program, "--config", folder.path("robot.json")}).exit == 0);
  CHECK(test::rsc({"check", program, "--config", folder.path("none.json")}).exit == 3);
}

TEST_CASE("a scenario or a trace with the name of a configuration is named") {
  const RobotFolder robot;
  const std::string quiz = robot.write("quiz.rsl", "AT START DO\n  LOG \"x\"\nEND\n");
  const std::vector<std::pair<std::string, std::string>> others = {
      {R"({"duration": "1s"})", "is a scenario"},
      {R"({"t_us":0,"step":1,"event":"activated"})", "is a trace"},
      {R"({"traceEvents": []})", "is a trace for Perfetto"},
      {R"({"kept": {}})", "is a file of kept numbers"}};
  for (const auto& [text, what] : others) {
    robot.write("quiz.json", text);
    for (const char* const verb : {"check", "run", "compile", "test"}) {
      const Outcome outcome = test::rsc({verb, quiz});
      CAPTURE(verb, outcome.err);
      CHECK(outcome.exit == 1);
      CHECK_THAT(outcome.err,
                 Contains("quiz.json " + what + ", but its name makes it the configuration of") &&
                     Contains("rename it") && Contains("--config FILE"));
    }
    CHECK(test::rsc({"check", quiz, "--config", robot.path("robot.json")}).exit == 0);
  }
}

TEST_CASE("--format json says what is wrong, whatever the verb") {
  const RobotFolder robot;
  const std::string wrong =
      robot.write("robot.rsl", "WHEN tuoch LEVEL < 3\nDO\n  LOG \"x\"\nEND\n");
  for (const char* const verb : {"check", "run", "compile", "test"}) {
    const Outcome outcome = test::rsc({verb, wrong, "--format", "json"});
    CAPTURE(verb, outcome.out, outcome.err);
    CHECK(outcome.exit == 1);
    const json report = json::parse(outcome.out);
    CHECK(report.at("diagnostics").at(0).at("code") == "E0501");
  }
  robot.write("robot.rsl", "WHEN touch LEVEL <\n");
  Outcome outcome = test::rsc({"explain", wrong, "--format", "json"});
  CHECK(outcome.exit == 1);
  CHECK(json::parse(outcome.out).at("errors") > 0);
  outcome = test::rsc({"check", robot.path("none.rsl"), "--format", "json"});
  CHECK(outcome.exit == 3);
  CHECK_THAT(json::parse(outcome.out).at("not_checked").at(0).at("why").get<std::string>(),
             Contains("cannot read"));
}

// What a terminal obeys is shown, not sent.
TEST_CASE("run shows control characters of a text as what they are") {
  const RobotFolder robot;
  robot.write("robot.rsl", "AT START DO\n  LOG \"\x1B]0;title\x07\"\nEND\n");
  const Outcome outcome = test::rsc({"run", robot.program});
  CAPTURE(outcome.out, outcome.err);
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("log: \\x1b]0;title\\x07"));
}

TEST_CASE("a scenario without a duration goes on to its last reading, and late ones are noted") {
  const RobotFolder robot;
  const auto run = [&](const std::string& duration, const std::vector<std::string>& more) {
    const std::string scenario = robot.write("visit.json", "{" + duration + R"("stimuli": [
      {"at": "1s", "sensor": "touch", "value": 5}, {"at": "60s", "sensor": "touch", "value": 2}]})");
    std::vector<std::string> arguments = {"run", robot.program, "--scenario", scenario};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::rsc(arguments);
  };
  const std::string note = "the run ends at 2.000 s: 1 of 2 readings come later and have no effect";
  Outcome outcome = run("", {});
  CAPTURE(outcome.out, outcome.err);
  CHECK_THAT(outcome.out, Contains("60.000 s  left_arm MOVE SLOWLY TO 90deg"));
  CHECK_THAT(outcome.err, !Contains("come later"));
  outcome = run(R"("duration": "2s", )", {});
  CHECK_THAT(outcome.out, !Contains("left_arm"));
  CHECK_THAT(outcome.err, Contains("visit.json: note: " + note));
  CHECK_THAT(run("", {"--duration", "2s"}).err, !Contains("come later"));
}

TEST_CASE("compile writes the image and says its size") {
  const RobotFolder robot;
  Outcome outcome = test::rsc({"compile", robot.program});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit == 0);
  const std::string image = robot.read("robot.rsb");
  CHECK_THAT(outcome.out, Contains(std::to_string(image.size()) + " bytes"));
  CHECK(robot.files() == 3);  // no temporary file is left

  outcome = test::rsc(
      {"compile", robot.program, "-o", robot.path("small.rsb"), "--strip", "--format", "json"});
  REQUIRE(outcome.exit == 0);
  const json report = json::parse(outcome.out);
  CHECK(report.at("bytes") == robot.read("small.rsb").size());
  CHECK(robot.read("small.rsb").size() < image.size());
  std::size_t sum = 0;
  for (const json& section : report.at("sections")) {
    sum += section.at("bytes").get<std::size_t>();
    CHECK(section.at("section") != "source lines");
  }
  CHECK(sum == report.at("bytes"));
}

TEST_CASE("a program with errors writes nothing and leaves the old image alone") {
  const RobotFolder robot;
  robot.write("robot.rsb", "old");
  robot.write("robot.rsl", wrong_program());
  const Outcome outcome = test::rsc({"compile", robot.program});
  CHECK(outcome.exit == 1);
  CHECK(outcome.out.empty());
  CHECK(robot.read("robot.rsb") == "old");
  CHECK(robot.files() == 3);
}

TEST_CASE("an image that cannot be written is exit 3") {
  const RobotFolder robot;
  const Outcome outcome = test::rsc({"compile", robot.program, "-o", "/no/such/place/x.rsb"});
  CHECK(outcome.exit == 3);
  CHECK_THAT(outcome.err, Contains("/no/such/place/x.rsb"));
}

TEST_CASE("dump shows names, rules and instructions with their lines") {
  const RobotFolder robot;
  REQUIRE(test::rsc({"compile", robot.program}).exit == 0);
  const Outcome outcome = test::rsc({"dump", robot.path("robot.rsb")});
  REQUIRE(outcome.exit == 0);
  for (const char* const text :
       {"touch: virtual_sensor", "channel 1 DISTANCE", "0 left_arm: servo", "MOVE: move",
        "SLOWLY: at 30", "shy: priority 60", "(line 5, when)", "line 2"}) {
    CHECK_THAT(outcome.out, Contains(text));
  }
}

TEST_CASE("dump says both pins of a motor") {
  const RobotFolder robot;
  const std::string config = robot.write("motor.json", R"({"actuators": [
    {"name": "wheel", "type": "PWM", "pins": [3, 4], "device": "motor"}]})");
  const std::string program = robot.write("runs.rsl", "AT START\nDO RUN wheel BACKWARD\nEND\n");
  CHECK_THAT(test::rsc({"dump", program, "--config", config}).out,
             Contains("0 wheel: motor on pins 3 and 4, range -100 … 100"));
}

TEST_CASE("dump says the pins of a drive, its trims and its measures") {
  const RobotFolder robot;
  const std::string config = robot.write("drive.json", R"({"actuators": [
    {"name": "base", "type": "PWM", "left": [3, 4], "right": [5, 6], "device": "differential_drive",
     "speed": "40cm/s", "track": "12cm", "trim": {"right": "95%"}}]})");
  const std::string program = robot.write("runs.rsl", "AT START\nDO SPIN base LEFT\nEND\n");
  CHECK_THAT(
      test::rsc({"dump", program, "--config", config}).out,
      Contains("0 base: differential_drive on pins 3 and 4 (left, 100 %), 5 and 6 (right, 95 %), "
               "400 with full power, track 120, usually 200, range"));
}

TEST_CASE("dump of a program shows each line above its instructions, optimised or not") {
  const RobotFolder robot;
  const std::string program = robot.write("counts.rsl", R"(REMEMBER count = 0
WHEN touch LEVEL > 2 DO
  SET count TO (count + 1) MOD 5
  IF count < 3 DO
    MOVE left_arm
  END
END
)");
  const std::string config = robot.path("robot.json");
  const Outcome optimized = test::rsc({"dump", program, "--config", config});
  REQUIRE(optimized.exit == 0);
  CHECK_THAT(optimized.out, Contains("  line 3: SET count TO (count + 1) MOD 5\n") &&
                                Contains("  add_k_fast ") && Contains("  unless_lt_k "));
  CHECK_THAT(optimized.out, Contains("  line 4: IF count < 3 DO\n") && Contains("  -> "));
  const Outcome plain = test::rsc({"dump", program, "--config", config, "-O0"});
  REQUIRE(plain.exit == 0);
  CHECK_THAT(plain.out, Contains("  line 4: IF count < 3 DO\n") && Contains("  mod "));
  CHECK_THAT(plain.out, !Contains("_fast") && !Contains("unless_lt"));
  CHECK(test::rsc({"dump", program, "--config", config, "-O2"}).exit == 2);
}

TEST_CASE("dump shows what a program remembers, its checks, timers and safety rules") {
  const RobotFolder robot;
  const std::string program = robot.write("memory.rsl", R"(STATE mood: calm, very scared
FEELING joy FROM 0% TO 100% START 50% FADES TO 20% OVER 60s
CHECK space OF proximity DISTANCE
  near BELOW 30cm
  far  OTHERWISE
  MARGIN 5cm
END
SAFETY guard
  WHEN touch LEVEL > 9 DO STOP ALL
  RESUME WHEN touch LEVEL < 1
END
WHEN space IS near FOR 2s COOLDOWN 10s DO
  IF mood IS calm DO
    REPEAT 3 TIMES
      RAISE joy BY 5%
    END
  ELSE
    SET mood TO very scared
  END
  MOVE left_arm
END
)");
  REQUIRE(test::rsc({"compile", program, "--config", robot.path("robot.json")}).exit == 0);
  const Outcome outcome = test::rsc({"dump", robot.path("memory.rsb")});
  REQUIRE(outcome.exit == 0);
  for (const char* const text :
       {"mood: state, starts at calm, labels calm | very scared",
        "joy: feeling, starts at 50%, range 0% … 100%, fades to 20%: of the distance 99.5 % stay",
        "space: of proximity DISTANCE", "near: up to 29", "stays up to 3", "FOR 2s", "COOLDOWN 10s",
        "safety rules, ", ", safety)", ", resume)", "modifiers 0"}) {
    CHECK_THAT(outcome.out, Contains(text));
  }
  // Blocks are indented, and jumps say where they go.
  CHECK_THAT(outcome.out, Contains("  times ") && Contains("  again ") && Contains("  -> "));
}

TEST_CASE("dump refuses a damaged image with the reason") {
  const RobotFolder robot;
  REQUIRE(test::rsc({"compile", robot.program}).exit == 0);
  std::string image = robot.read("robot.rsb");
  image[image.size() / 2] = static_cast<char>(image[image.size() / 2] ^ 1);
  Outcome outcome = test::rsc({"dump", robot.write("damaged.rsb", image)});
  CHECK(outcome.exit == 1);
  CHECK(outcome.out.empty());
  CHECK_THAT(outcome.err, Contains("damaged.rsb: the image is damaged"));

  outcome = test::rsc({"dump", robot.write("short.rsb", image.substr(0, 20))});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("cut off"));
  outcome = test::rsc({"dump", robot.write("empty.rsb", "")});
  CHECK(outcome.exit == 1);
  outcome = test::rsc({"run", robot.write("text.rsb", "WHEN touch LEVEL < 3 DO\n")});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("text.rsb"));
}

TEST_CASE("run says that nothing reports without a scenario, if there is a sensor") {
  const RobotFolder robot;
  constexpr const char* kNote = "without a scenario no sensor reports anything";
  CHECK_THAT(test::rsc({"run", robot.program}).err, Contains(kNote));
  const std::string scenario = robot.write("none.json", R"({"duration": "1s"})");
  CHECK_THAT(test::rsc({"run", robot.program, "--scenario", scenario}).err, !Contains(kNote));
  const std::string blind = robot.write("blind.rsl", "AT START DO\n  LOG \"x\"\nEND\n");
  CHECK_THAT(test::rsc({"run", blind}).err, !Contains(kNote));
}

TEST_CASE("run shows what happened, in words and as a trace") {
  const RobotFolder robot;
  const std::string scenario = robot.write("visit.json", R"({"duration": "3s", "stimuli": [
      {"at": "1s", "sensor": "touch", "channel": "LEVEL", "value": 2}]})");
  const Outcome outcome = test::rsc({"run", robot.program, "--scenario", scenario, "--all",
                                     "--trace", robot.path("visit.jsonl")});
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("   1.000 s  touch LEVEL = 2\n") &&
                              Contains("rule at line 1 starts") &&
                              Contains("left_arm MOVE SLOWLY TO 90"));
  const std::vector<json> trace = json_lines(robot.read("visit.jsonl"));
  REQUIRE(!trace.empty());
  CHECK(trace.front().at("event") == "activated");
  const auto command =
      std::ranges::find_if(trace, [](const json& event) { return event.at("event") == "command"; });
  REQUIRE(command != trace.end());
  CHECK(command->at("t_us") == 1'000'000);
  CHECK(command->at("actuator") == "left_arm");
  CHECK(command->at("to") == 90);

  const Outcome as_json =
      test::rsc({"run", robot.program, "--scenario", scenario, "--format", "json"});
  CHECK(as_json.out == robot.read("visit.jsonl"));
}

TEST_CASE("run shows what a person wants to see, in the units of the files") {
  const Folder folder;
  folder.write("robot.json", R"({"sensors": [
      {"name": "near", "type": "VIRTUAL", "channels": {"DISTANCE": {"unit": "cm", "range": [0, 400]}}}],
    "actuators": [{"name": "arm", "type": "PWM", "pin": 3, "device": "servo", "range": ["0deg", "90deg"]},
      {"name": "base", "type": "VIRTUAL", "device": "drive"}]})");
  folder.write("more.rsl",
               "BEHAVIOR lower PRIORITY 10\n  WHEN near DISTANCE < 50cm\n  DO MOVE arm TO 5deg\n"
               "  END\nEND\n");
  const std::string program = folder.write(
      "robot.rsl",
      "USE \"more.rsl\"\nREMEMBER last = 0cm\nFEELING fear FROM 0% TO 100% START 0%\n"
      "  FADES TO 0% OVER 2s\nBEHAVIOR upper PRIORITY 20\n  WHEN near DISTANCE < 50cm DO\n"
      "    SET last TO near DISTANCE\n    RAISE fear BY 80%\n    MOVE arm TO 30deg\n"
      "    DRIVE base FORWARD 20cm\n    TURN base LEFT 90deg\n  END\nEND\n");
  const std::string scenario = folder.write("visit.json", R"({"duration": "5s", "stimuli": [
      {"at": "0s", "sensor": "near", "value": "300cm"}, {"at": "1s", "sensor": "near", "value": "20cm"}]})");
  const std::string some = test::rsc({"run", program, "--scenario", scenario}).out;
  CHECK_THAT(some, Contains("arm MOVE TO 30deg\n") && Contains("last becomes 20cm\n") &&
                       Contains("fear becomes 80%\n") && Contains("more.rsl:2 does not start") &&
                       Contains("behaviour upper has an"));
  CHECK_THAT(some,
             Contains("base DRIVE FORWARD BY 20cm\n") && Contains("base TURN LEFT BY 90deg\n"));
  CHECK_THAT(some, !Contains("DISTANCE =") && !Contains("triggers") && !Contains("is done"));
  CHECK(std::ranges::count(some, '\n') < 25);
  const std::string all = test::rsc({"run", program, "--scenario", scenario, "--all"}).out;
  CHECK_THAT(all, Contains("near DISTANCE = 20cm\n") && Contains("rule at line 6 triggers") &&
                      Contains("arm is done"));
  CHECK(std::ranges::count(all, '\n') > 50);
}

TEST_CASE("check --timing says so where no reading commands an actuator in its own step") {
  const Folder folder;
  folder.write("robot.json", test::kRobot);
  const std::string by_variable =
      folder.write("robot.rsl",
                   "REMEMBER n = 0\nWHEN touch LEVEL > 3\nDO SET n TO 1\nEND\nWHEN n > 0\nDO MOVE "
                   "left_arm TO 9deg\nEND\n");
  const std::string out = test::rsc({"check", "--timing", by_variable}).out;
  CHECK_THAT(out, Contains("No reading commands an actuator in its own step.") &&
                      Contains("processor, in total"));
  CHECK(out.find("at most") == std::string::npos);
  const RobotFolder robot;
  CHECK_THAT(test::rsc({"check", "--timing", robot.program}).out,
             Contains("from a reading to the command          at most"));
}

TEST_CASE("blank lines and comments change nothing that is drawn") {
  const RobotFolder robot;
  const std::string rule =
      "EVERY 1s\nDO\n  PICK ONE\n    OPTION LOG \"one\"\n    OPTION LOG \"two\"\n  END\nEND\n";
  const std::string plain = robot.write("plain.rsl", rule);
  const std::string aired = robot.write("aired.rsl", "\n% first\n\n" + rule + "\n# last\n");
  const auto drawn = [](const std::string& program, const char* seed) {
    return test::rsc({"run", program, "--duration", "60s", "--seed", seed}).out;
  };
  CHECK_THAT(drawn(plain, "9"), Contains("log: one") && Contains("log: two"));
  CHECK(drawn(plain, "9") == drawn(aired, "9"));
  CHECK(drawn(plain, "9") != drawn(plain, "10"));
}

TEST_CASE("every board has room for 16 servos with 12 behaviours") {
  const Folder folder;
  std::string program = "LIMIT s0 SPEED TO 60deg/s\n";
  json robot{{"sensors", {{{"name", "touch"}, {"type", "VIRTUAL"}}}}, {"actuators", json::array()}};
  for (unsigned i = 0; i < 16; ++i)
    robot["actuators"].push_back(
        {{"name", "s" + std::to_string(i)}, {"type", "VIRTUAL"}, {"device", "joint"}});
  for (unsigned i = 0; i < 12; ++i) {
    const std::string number = std::to_string(i);
    program += "BEHAVIOR b" + number + " PRIORITY " + std::to_string(i + 1) +
               "\n  WHEN touch LEVEL > " + number + "\n  DO\n    MOVE s" + number +
               " TO 30deg\n    MOVE s" + std::to_string((i + 4) % 16) + " TO 60deg\n  END\nEND\n";
  }
  for (const std::string_view board : compiler::board_names()) {
    CAPTURE(std::string(board));
    robot["board"] = std::string(board);
    folder.write("robot.json", robot.dump());
    const Outcome outcome = test::rsc({"check", folder.write("robot.rsl", program)});
    CAPTURE(outcome.err);
    CHECK(outcome.exit == 0);
  }
}

TEST_CASE("run takes an image, and a duration that ends it") {
  const RobotFolder robot;
  REQUIRE(test::rsc({"compile", robot.program}).exit == 0);
  const std::string scenario = robot.write("visit.json", R"({"stimuli": [
      {"at": "1s", "sensor": "touch", "value": 2}]})");
  const std::string image = robot.path("robot.rsb");
  CHECK_THAT(test::rsc({"run", image, "--scenario", scenario, "--all"}).out,
             Contains("touch LEVEL = 2"));
  CHECK_THAT(test::rsc({"run", image, "--scenario", scenario, "--duration", "900ms", "--all"}).out,
             !Contains("touch LEVEL"));
}

TEST_CASE("a wrong scenario is exit 1 with file and line, a missing one exit 3") {
  const RobotFolder robot;
  const std::string scenario = robot.write("visit.json", "{\n\"stimuly\": []}");
  Outcome outcome = test::rsc({"run", robot.program, "--scenario", scenario});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("visit.json:2: "));
  outcome = test::rsc({"run", robot.program, "--scenario", robot.path("none.json")});
  CHECK(outcome.exit == 3);
}

TEST_CASE("a file that uses itself, or is used by what it uses, is in the program once") {
  const Folder folder;
  folder.write("robot.json", R"({"actuators": []})");
  const std::string rule = "AT START\nDO LOG \"once\"\nEND\n";
  const std::string itself = folder.write("itself.rsl", "USE \"itself.rsl\"\n" + rule);
  const std::string circle = folder.write("circle.rsl", "USE \"other.rsl\"\n" + rule);
  folder.write("other.rsl", "USE \"./circle.rsl\"\nUSE \"other.rsl\"\n");
  for (const std::string& program : {itself, circle}) {
    const Outcome ran = rsc({"run", program, "--config", folder.path("robot.json")});
    CHECK(ran.exit == 0);
    const std::size_t first = ran.out.find("once");
    REQUIRE(first != std::string::npos);
    CHECK(ran.out.find("once", first + 1) == std::string::npos);
  }
}

TEST_CASE("JSON in the place of a program is left alone, and the program is named") {
  const RobotFolder robot;
  const std::string wiring = "{board: \"microbit-v2\",\n sensors: []}\n";
  const std::string file = robot.write("pet.json", wiring);
  const std::string scenario = robot.write("track.json", R"({"duration": "1s"})");
  for (const char* const verb : {"check", "fix", "run", "compile", "explain"}) {
    CAPTURE(verb);
    Outcome outcome = test::rsc({verb, file});
    CHECK(outcome.exit == 1);
    CHECK_THAT(outcome.err, Contains("pet.json is the configuration of a robot, not a program: "
                                     "name the program, such as ") &&
                                Contains("pet.rsl; its configuration is read with it"));
    CHECK_THAT(test::rsc({verb, scenario}).err,
               Contains("track.json is a scenario, not a program"));
  }
  CHECK(robot.read("pet.json") == wiring);
  const Outcome outcome = test::rsc({"check", robot.program, "--config", scenario});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("track.json is a scenario, not the configuration of a robot") &&
                              !Contains("error["));
}

TEST_CASE("an image in the place of a program is called one") {
  const RobotFolder robot;
  REQUIRE(test::rsc({"compile", robot.program}).exit == 0);
  const std::string image = robot.read("robot.rsb");
  for (const char* const verb : {"check", "fix", "fmt", "test", "explain"}) {
    const Outcome outcome = test::rsc({verb, robot.path("robot.rsb")});
    CAPTURE(verb, outcome.err);
    CHECK(outcome.exit == 1);
    CHECK_THAT(outcome.err, Contains("robot.rsb is an image already, not a program: name the "
                                     "program, such as ") &&
                                Contains("robot.rsl\n") && !Contains("NUL"));
  }
  CHECK(robot.read("robot.rsb") == image);
}
