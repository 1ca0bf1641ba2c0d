// Programs in plain English: whole programs, and each construct.
#include "compiler/explain/program_text.hpp"

#include <algorithm>
#include <filesystem>

#include <catch2/catch.hpp>

#include "compiler/config/robot_reader.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/explain/conditions.hpp"
#include "compiler/syntax/parser.hpp"
#include "tests/support/golden.hpp"

using namespace robosync;
using namespace robosync::compiler;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const fs::path kTests = fs::path(ROBOSYNC_SOURCE_DIR) / "tests/compiler";

struct Read {
  SourceMap sources;
  Diagnostics diagnostics;
  ast::Tree program;
  std::optional<Robot> robot;
};

Read read(std::string text, const std::string& robot = {}) {
  Read result;
  const FileId file = result.sources.add("robot.rsl", std::move(text));
  const FileId config = result.sources.add("robot.json", robot);
  result.program = parse(result.sources, file, result.diagnostics);
  INFO(render_human(result.diagnostics, result.sources, false));
  REQUIRE(result.diagnostics.errors() == 0);
  if (!robot.empty()) {
    result.robot = read_robot(result.sources, config, result.diagnostics);
    INFO(render_human(result.diagnostics, result.sources, false));
    REQUIRE(result.diagnostics.errors() == 0);
  }
  return result;
}

std::string told(const std::string& text, const std::string& robot = {}) {
  const Read it = read(text, robot);
  const ast::Tree* const tree = &it.program;
  return explain::program_text({&tree, 1}, it.sources, it.robot ? &*it.robot : nullptr);
}

// The first line of the rule `WHEN condition DO` or the like.
std::string first_line(const std::string& head) {
  const std::string text = told(head + " DO\n  SHOW face\nEND");
  const std::size_t begin = text.find("It uses face.\n") + std::string("It uses face.\n  ").size();
  return text.substr(begin, text.find(" (line 1):", begin) - begin);
}

std::string stmt(const std::string& text) {
  const std::string all = told("WHEN touch > 3 DO\n" + text + "\nEND");
  const std::size_t begin = all.find("(line 1):\n") + std::string("(line 1):\n").size();
  return all.substr(begin);
}

}  // namespace

TEST_CASE("the programs of the language's design in plain English", "[golden]") {
  std::vector<fs::path> programs;
  for (const auto& entry : fs::directory_iterator(kTests / "syntax/programs")) {
    if (entry.path().extension() == ".rsl") programs.push_back(entry.path());
  }
  REQUIRE(programs.size() >= 7);
  for (const fs::path& path : programs) {
    const fs::path golden = kTests / "explain/golden" / path.filename().replace_extension(".txt");
    testing::expect_golden(golden, told(testing::read_file(path)));
  }
}

TEST_CASE("the first words say whether a rule looks at a moment or at a time") {
  CHECK(first_line("WHEN proximity DISTANCE < 30cm") ==
        "As soon as proximity DISTANCE becomes less than 30cm");
  CHECK(first_line("WHILE proximity DISTANCE < 30cm") ==
        "While proximity DISTANCE is less than 30cm");
  CHECK(first_line("EVERY 3s TO 7s") == "Every 3s to 7s, at random");
  CHECK(first_line("EVERY 3s") == "Every 3s");
  CHECK(first_line("WHEN a > 1 AND b > 2") ==
        "As soon as it becomes true that a is more than 1 and b is more than 2");
  CHECK(first_line("WHILE a > 1 OR b > 2") ==
        "While it is true that a is more than 1 or b is more than 2");
}

TEST_CASE("every comparison has its words") {
  CHECK(first_line("WHEN a < 1") == "As soon as a becomes less than 1");
  CHECK(first_line("WHEN a > 1") == "As soon as a becomes more than 1");
  CHECK(first_line("WHEN a <= 1") == "As soon as a becomes at most 1");
  CHECK(first_line("WHEN a >= 1") == "As soon as a becomes at least 1");
  CHECK(first_line("WHEN a = 1") == "As soon as a becomes exactly 1");
  CHECK(first_line("WHEN a <> 1") == "As soon as a becomes anything but 1");
  CHECK(first_line("WHEN a IS very close") == "As soon as a becomes very close");
  CHECK(first_line("WHILE a IS NOT scared") == "While a is anything but scared");
  CHECK(first_line("WHEN a IS \"stop\"") == "As soon as a becomes \"stop\"");
  CHECK(first_line("WHEN a IS BETWEEN 1 AND 2") == "As soon as a becomes between 1 and 2");
  CHECK(first_line("WHEN a IS TRUE") == "As soon as a becomes true");
  CHECK(first_line("WHEN waved") == "As soon as waved becomes true");
  CHECK(first_line("WHILE NOT waved") == "While waved is not true");
  CHECK(first_line("WHEN NOT a > 1") == "As soon as a stops being more than 1");
  CHECK(first_line("WHEN mood BECOMES calm") == "As soon as mood becomes calm");
  CHECK(first_line("WHEN a CHANGES") == "As soon as a changes");
  CHECK(first_line("WHEN a CHANGES BY 5") == "As soon as a changes by 5 or more");
  CHECK(first_line("WHEN a - 2 * b > (3 + 4) MOD 5") ==
        "As soon as a - (2 * b) becomes more than (3 + 4) MOD 5");
}

TEST_CASE("time words and brackets") {
  CHECK(first_line("WHEN a > 1 FOR 2s") ==
        "As soon as a has been more than 1 for 2s without a break");
  CHECK(first_line("WHEN NOT a > 1 FOR 2s") ==
        "As soon as a has not been more than 1 for 2s without a break");
  CHECK(first_line("WHEN a > 1 AND b FOR 2s") ==
        "As soon as it has been true for 2s without a break that a is more than 1 and b is true");
  CHECK(first_line("WHEN a > 1 3 TIMES WITHIN 2s") ==
        "As soon as a becomes more than 1 for the 3rd time within 2s");
  CHECK(first_line("WHEN a > 1 12 TIMES WITHIN 2s") ==
        "As soon as a becomes more than 1 for the 12th time within 2s");
  CHECK(first_line("WHEN a > 70% THEN a < 20% WITHIN 2s") ==
        "As soon as a becomes more than 70% and then, at most 2s later, a becomes less than 20%");
  CHECK(first_line("WHEN (a OR b) AND c") ==
        "As soon as it becomes true that (a is true or b is true) and c is true");
  CHECK(first_line("WHILE NOT (a OR b)") ==
        "While it is true that it is not true that (a is true or b is true)");
}

TEST_CASE("every statement in words") {
  CHECK(stmt("MOVE right_arm QUICKLY TO -20deg OVER 400ms") ==
        "    - move right_arm quickly to -20deg over 400ms\n");
  CHECK(stmt("SPIN base 2 TIMES") == "    - spin base 2 times\n");
  CHECK(stmt("SPIN base 1 TIMES") == "    - spin base once\n");
  CHECK(stmt("SAY \"Hello\"") == "    - say \"Hello\"\n");
  CHECK(stmt("TURN head TO (voice DIRECTION)") == "    - turn head to voice DIRECTION\n");
  CHECK(stmt("SET n TO RANDOM(1, 6)") == "    - set n to a random number from 1 to 6\n");
  CHECK(stmt("RAISE joy BY 15%") == "    - raise joy by 15%\n");
  CHECK(stmt("LOWER joy BY 15%") == "    - lower joy by 15%\n");
  CHECK(stmt("WAIT 2s") == "    - wait 2s\n");
  CHECK(stmt("WAIT UNTIL a > 1") == "    - wait until a is more than 1\n");
  CHECK(stmt("WAIT UNTIL a > 1 WITHIN 3s") ==
        "    - wait until a is more than 1, for at most 3s\n");
  CHECK(stmt("THEN") == "    - wait until everything started so far is done\n");
  CHECK(stmt("STOP ALL") == "    - stop all actuators\n");
  CHECK(stmt("STOP arms") == "    - stop arms\n");
  CHECK(stmt("SIGNAL hello") == "    - send the signal hello to the other rules\n");
  CHECK(stmt("LOG \"level\", a + 1") == "    - write to the log: \"level\", a + 1\n");
  CHECK(stmt("ALERT \"help\"") == "    - alert a person: \"help\"\n");
  CHECK(stmt("IF a > 1 DO WAIT 1s ELSE WAIT 2s END") ==
        "    - if a is more than 1:\n        - wait 1s\n    - otherwise:\n        - wait 2s\n");
  CHECK(stmt("REPEAT 3 TIMES\nWAIT 1s\nEND") == "    - 3 times:\n        - wait 1s\n");
  CHECK(stmt("REPEAT WHILE a > 1\nWAIT 1s\nEND") ==
        "    - again and again while a is more than 1:\n        - wait 1s\n");
  CHECK(stmt("REPEAT FOREVER\nWAIT 1s\nEND") ==
        "    - again and again, until something interrupts it:\n        - wait 1s\n");
  CHECK_THAT(stmt("PICK ONE\nOPTION 60% WAIT 1s\nOPTION 40% WAIT 2s\nEND"),
             Contains("the larger its number") && Contains("- option 60%:"));
  CHECK_THAT(stmt("PICK ONE\nOPTION WAIT 1s\nOPTION WAIT 2s\nEND"), Contains("all equally likely"));
}

TEST_CASE("modifiers are told in words a teacher understands") {
  const std::string text =
      told("WHEN a > 60C COOLDOWN 10s MARGIN 5C RESTARTING WAITING 2s DO\n  SHOW face\nEND");
  CHECK_THAT(text, Contains("After it has started, it does not start again for 10s."));
  CHECK_THAT(text, Contains("stays true until the value is 5C back past its limit"));
  CHECK_THAT(text, Contains("If it becomes true again while this is still running, it starts "
                            "again from the top."));
  CHECK_THAT(text, Contains("it waits for at most 2s."));
  CHECK_THAT(told("WHEN a > 60C COOLDOWN 10s DO\n  SHOW face\nELSE\n  SHOW face\nEND"),
             Contains("After a side has started, that side does not start again for 10s."));
  const std::string plain = told("WHEN a > 60C DO\n  SHOW face\nEND");
  CHECK_THAT(plain, !Contains("After it has started") && !Contains("starts again from the top"));
}

TEST_CASE("who interrupts whom: by actuators and priorities, through DEFINEs and groups") {
  const std::string program = R"(
BEHAVIOR high PRIORITY 80
  WHEN a > 1 DO hello
  END
END
BEHAVIOR low PRIORITY 20
  WHEN a > 2 DO MOVE left_arm
  END
END
BEHAVIOR other PRIORITY 50
  WHEN a > 3 DO SHOW face
  END
END
WHEN a > 4 DO MOVE right_arm
END
DEFINE hello
  MOVE arms
END
)";
  // Without a robot nobody knows that left_arm is one of the arms.
  CHECK_THAT(told(program), !Contains("It interrupts") && !Contains("is interrupted by"));
  const std::string robot = R"({"sensors": [{"name": "a", "type": "VIRTUAL"}],
    "actuators": [{"name": "left_arm", "type": "PWM", "pin": 1, "device": "servo"},
                  {"name": "right_arm", "type": "PWM", "pin": 2, "device": "servo"},
                  {"name": "face", "type": "VIRTUAL", "device": "face"}],
    "groups": {"arms": ["left_arm", "right_arm"]}})";
  const std::string text = told(program, robot);
  CHECK_THAT(text,
             Contains("BEHAVIOR high (line 2), priority 80:\n  It uses left_arm and right_arm.\n"
                      "  It interrupts low (priority 20) and the rule at line 14.\n"));
  CHECK_THAT(text, Contains("BEHAVIOR low (line 6), priority 20:\n  It uses left_arm.\n"
                            "  It is interrupted by high (priority 80).\n"));
  CHECK_THAT(text, Contains("BEHAVIOR other (line 10), priority 50:\n  It uses face.\n\n"));
}

TEST_CASE("a DEFINE that runs itself is told and ends") {
  CHECK_THAT(told("WHEN a > 1 DO b\nEND\nDEFINE b\n  c\nEND\nDEFINE c\n  b\nEND"),
             Contains("do b (see DEFINE b)"));
}

TEST_CASE("PERFORM uses the actuators of its MOTION, and interrupts who has one of them") {
  const std::string motion = "MOTION w OF arms, lamp\n  AT 1s 9deg -\nEND\n";
  const std::string rules =
      "BEHAVIOR arm PRIORITY 50\n  WHEN a > 1 DO PERFORM W 2 TIMES\n  END\nEND\n"
      "BEHAVIOR shine PRIORITY 30\n  WHEN a > 2 DO MOVE left_arm TO 0deg\n  END\nEND\n";
  const std::string robot = R"({
    "sensors": [{"name": "a", "type": "VIRTUAL", "channels": {"X": {}}}],
    "actuators": [{"name": "left_arm", "type": "VIRTUAL", "device": "joint", "range": ["0deg", "90deg"]},
                  {"name": "right_arm", "type": "VIRTUAL", "device": "joint", "range": ["0deg", "90deg"]},
                  {"name": "lamp", "type": "VIRTUAL", "device": "joint", "range": ["0deg", "90deg"]}],
    "groups": {"arms": ["left_arm", "right_arm"]}})";
  CHECK_THAT(told(motion + rules, robot), Contains("It uses lamp, left_arm and right_arm.\n"
                                                   "  It interrupts shine (priority 30).\n"));
  CHECK_THAT(told(motion + rules), Contains("priority 50:\n  It uses arms and lamp.\n"));
  CHECK_THAT(told(rules), Contains("priority 50:\n  It uses W.\n"));
}

TEST_CASE("a LIST is one of texts or of numbers") {
  CHECK_THAT(told("LIST n: 1, 2, 3\n"), Contains("n is a list of 3 numbers.\n"));
  CHECK_THAT(told("LIST n: 1\n"), Contains("n is a list of 1 number.\n"));
  CHECK_THAT(told("LIST n: \"a\", \"b\"\n"), Contains("n is a list of 2 texts.\n"));
}

TEST_CASE("a side of a rule with ELSE waits as long as it takes, whatever WAITING says") {
  for (const std::string waiting : {"", "WAITING 1s"}) {
    const std::string text =
        told("WHEN a > 1 " + waiting + " DO\n  SHOW face\nELSE\n  HIDE face\nEND");
    CHECK_THAT(text, !Contains("at most 1s") &&
                         Contains("that side runs as soon as all of it is free, if it still "
                                  "applies.\n"));
  }
}

TEST_CASE("a MARGIN belongs to the comparisons, and NOT turns round what they give") {
  const auto margin = [](const std::string& condition) {
    return told("WHEN " + condition + " MARGIN 10cm DO\n  SHOW face\nEND");
  };
  for (const char* const one : {"a < 50cm", "a < 50cm FOR 1s", "a IS BETWEEN 1cm AND 50cm"})
    CHECK_THAT(margin(one), Contains("  Once true, it stays true until the value is 10cm back past "
                                     "its limit, so that it does not flicker.\n"));
  const std::string each =
      "  Each comparison in it with this kind of unit, once true, stays true until the value is "
      "10cm back past its limit, "
      "so that it does not flicker";
  CHECK_THAT(margin("a < 50cm AND b < 3cm"), Contains(each + ".\n"));
  for (const char* const turned : {"NOT (a < 50cm)", "a < 50cm AND NOT b"})
    CHECK_THAT(margin(turned), Contains(each + "; NOT reverses the result.\n"));
}

TEST_CASE("what the modules of a program do is told as if it stood in the program") {
  SourceMap sources;
  Diagnostics diagnostics;
  const FileId own = sources.add("robot.rsl",
                                 "USE \"guard.rsl\"\nBEHAVIOR mine PRIORITY 20\n  WHEN touch > 3\n"
                                 "  DO waveit\n  END\nEND\n");
  const FileId used = sources.add("guard.rsl",
                                  "BEHAVIOR mover PRIORITY 70\n  WHEN touch > 5\n  DO MOVE arm\n"
                                  "  END\nEND\nSAFETY pinch\n  WHEN touch > 9\n  DO STOP ALL\nEND\n"
                                  "DEFINE waveit\n  nod\n  MOVE arm SLOWLY\nEND\n"
                                  "DEFINE nod\n  MOVE head\nEND\nDEFINE unused\n  MOVE leg\nEND\n");
  const ast::Tree program = parse(sources, own, diagnostics);
  const ast::Tree module = parse(sources, used, diagnostics);
  const std::vector<const ast::Tree*> trees{&program, &module};
  const std::string text = explain::program_text(trees, sources, nullptr);
  CHECK_THAT(text, Contains("BEHAVIOR mover (line 1 of guard.rsl), priority 70:") &&
                       Contains("SAFETY pinch (line 6 of guard.rsl)"));
  CHECK_THAT(text, Contains("It uses arm and head.\n  It is interrupted by mover (priority 70)"));
  CHECK_THAT(text, Contains("DEFINE waveit (line 10 of guard.rsl) means:") &&
                       Contains("DEFINE nod (line 14 of guard.rsl) means:") && !Contains("unused"));
}

TEST_CASE("what moves has its limits, its halt and its release, and lamps have none") {
  const std::string text = told("AT START DO\n  MOVE arm TO 10deg\nEND", R"({"actuators": [
    {"name": "arm", "device": "servo", "pin": 10, "safe": "coast", "on_release": "rest",
     "limits": {"SPEED": "100deg/s", "ACCELERATION": "200deg/s2"}},
    {"name": "neck", "device": "servo", "pin": 11},
    {"name": "wheel", "device": "motor", "pins": [4, 5], "limits": {"SPEED": "50%"}},
    {"name": "lamp", "device": "pwm", "pin": 6}, {"name": "face", "type": "VIRTUAL", "device": "face"}]})");
  CHECK_THAT(
      text,
      Contains("\nWhat moves, as robot.json and LIMITs say:\n") &&
          Contains(
              "  arm: It goes no faster than 100deg/s. Its speed changes by at most 200deg/s2. "
              "In a halt it goes limp; when its response ends, it goes to its rest position.\n") &&
          Contains("  neck: In a halt it ") &&
          Contains("  wheel: It goes no faster than 50%. In a halt it is off; when its response "
                   "ends, it is off.\n") &&
          Contains("`rsc resume`"));
  CHECK_THAT(text, !Contains("lamp:") && !Contains("face:"));
  CHECK_THAT(told("AT START DO\n  LOG \"a\"\nEND",
                  R"({"actuators": [{"name": "lamp", "device": "pwm", "pin": 6}]})"),
             !Contains("What moves"));
}
