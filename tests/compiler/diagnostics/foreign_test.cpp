// Text in the form of another language: one error, which says how RSL writes it.
#include <catch2/catch.hpp>

#include "tests/compiler/compiled.hpp"

using namespace robosync::compiler;
using namespace robosync::compiler::testing;
using Catch::Contains;

namespace {

struct Case {
  std::string program, says;
};

std::string rule(const std::string& line) {
  return "WHEN touch LEVEL < 3 DO\n  " + line + "\nEND\n";
}

const std::string kForeign = "another language", kAgain = "EVERY 1s DO", kOnce = "AT START DO",
                  kWhen = "WHEN touch LEVEL < 3 DO", kWait = "WAIT 500ms";

// Each of them as a pupil would bring it along, from top to bottom.
const Case kCases[] = {
    // C++, as for Arduino
    {"void setup() {\n  pinMode(13, OUTPUT);\n}\n\nvoid loop() {\n  digitalWrite(13, HIGH);\n"
     "  delay(500);\n}\n",
     kOnce},
    {"Servo arm;\nint pos = 0;\nvoid loop()\n{\n  if (analogRead(A0) > 500) {\n    arm.write(90);\n"
     "  } else {\n    arm.write(0);\n  }\n}\n",
     kAgain},
    {"int main() {\n  printf(\"hi\");\n  return 0;\n}\n", "LOG \"hello\""},
    {"for (int i = 0; i < 3; i++) {\n  SHOW face happy;\n}\n", "REPEAT 3 TIMES"},
    {"digitalWrite(13, HIGH);\n", "verb and an actuator"},
    {rule("delay(500);"), kWait},
    {rule("left_arm.write(90)"), "MOVE left_arm TO 60deg"},
    {rule("if (touch > 3) {\n    digitalWrite(13, HIGH);\n  }"), kForeign},
    {"while (true) {\n  delay(100);\n}\n", kAgain},
    // Python
    {"def react():\n    servo.write(90)\n    print(\"hi\")\n\nreact()\n", "DEFINE react"},
    {"from machine import Pin\nimport time\n\nwhile True:\n    if touch > 3:\n        "
     "arm.move(90)\n"
     "    else:\n        arm.move(0)\n    time.sleep(1)\n",
     "RSL needs no imports"},
    {"for i in range(3):\n    print(\"hi\")\n", "REPEAT 3 TIMES"},
    {rule("for i in range(3):\n    SHOW face happy"), "REPEAT 3 TIMES"},
    {"class Robot:\n    def react(self):\n        return self.x\n", "DEFINE Robot"},
    {"WHEN touch LEVEL < 3:\n    SHOW face happy\nELSE:\n    SHOW face sad\n", kWhen},
    {"WHEN touch LEVEL < 3 AND\n    touch LEVEL > 1:\n    SHOW face happy\n", "touch LEVEL > 1 DO"},
    {rule("IF touch LEVEL > 1:\n    IF touch LEVEL > 2:\n      SHOW face happy"),
     "IF touch LEVEL > 1 DO"},
    {rule("repeat 3:\n    SHOW face happy"), "repeat 3 TIMES"},
    {"if touch LEVEL < 3:\n    SHOW face happy\nelif touch LEVEL < 5:\n    SHOW face sad\nelse:\n"
     "    LOG \"x\"\n",
     kWhen},
    {"if touch LEVEL < 3:\n    SHOW face happy\nif touch LEVEL > 5:\n    SHOW face sad\n", kWhen},
    // JavaScript, Lua, BASIC
    {"function react() {\n  console.log(\"hi\");\n}\nsetInterval(react, 100);\n", "DEFINE react"},
    {"input.onButtonPressed(Button.A, function () {\n    basic.pause(100)\n})\n", kWait},
    {"function react()\n  if touch > 3 then\n    print(\"hi\")\n  end\nend\n", "DEFINE react"},
    {"switch (x) {\n  case 1: SHOW face happy; break;\n}\n", kForeign},
    {"IF touch LEVEL < 3 THEN\n  SHOW face happy\nEND\n", kWhen},
    {"IF touch LEVEL < 3 THEN\nSHOW face happy\nEND IF\n", kWhen},
    {"IF touch LEVEL < 3 THEN SHOW face happy\n", kWhen},
    {"IF touch LEVEL < 3\n  SHOW face happy\nEND\n", kWhen},
    {"10 PRINT \"hi\"\n20 GOTO 10\n", "LOG \"hello\""},
    {"10 REM my robot\n20 LET X = 5\n30 IF X > 3 THEN GOTO 60\n40 FOR I = 1 TO 3\n50 NEXT I\n60 "
     "END\n",
     "REMEMBER x = 0"},
    {"10 print \"hi\"\n" + rule("SHOW face happy"), kForeign},
    // several habits in one line
    {"REMEMBER y = 0\nif (touch LEVEL > 3) { y = 5; }\n",
     "`WHEN touch LEVEL > 3 DO SET y TO 5 END`"},
    {"REMEMBER y = 0\n" + rule("if (touch LEVEL > 3) { y = 5; }"),
     "`IF touch LEVEL > 3 DO SET y TO 5 END`"},
    {"REMEMBER x = 0\nIF touch LEVEL > 3 THEN x = 5\n", "`WHEN touch LEVEL > 3 DO SET x TO 5 END`"},
    {"REMEMBER x = 0\n" + rule("IF touch LEVEL > 3 THEN x = 5"),
     "`IF touch LEVEL > 3 DO SET x TO 5 END`"},
    {"REMEMBER x = 0\n" + rule("IF touch LEVEL > 3 THEN x = 5 ELSE x = 6"),
     "`IF touch LEVEL > 3 DO SET x TO 5 ELSE SET x TO 6 END`"},
    {"REMEMBER y = 0\n" + rule("if ((touch LEVEL > 3) && (y == 0)) { y += 1; } else { y--; }"),
     "`IF (touch LEVEL > 3) AND (y == 0) DO RAISE y BY 1 ELSE LOWER y BY 1 END`"},
    {"REMEMBER y = 0\n" + rule("if (touch LEVEL > 3) { y = 5; SHOW face happy; }"),
     "`IF touch LEVEL > 3 DO`, then each command on a line of its own, such as `SET y TO 5`"},
    {"IF touch LEVEL > 3 THEN PRINT \"hi\"\n", "`WHEN touch LEVEL > 3 DO LOG \"hi\" END`"},
    {"BEHAVIOR b PRIORITY 3\n  if (touch LEVEL > 3) { SHOW face happy; }\nEND\n",
     "`WHEN touch LEVEL > 3 DO SHOW face happy END`"},
    // Scratch
    {"when green flag clicked\nforever\n  move 10 steps\n  if <touching edge> then\n    turn 15\n"
     "  end\nend\n",
     kOnce},
    {"when button A pressed\n  show face happy\nend\n", "WHEN touch LEVEL > 5 DO"},
    {"on button pressed\n  SHOW face happy\n", "WHEN touch LEVEL > 5 DO"},
    {"forever\n  SHOW face happy\n", "the commands, and `END`"},
    // assignments and signs
    {"REMEMBER x = 0\n" + rule("x := 4"), "SET x TO 4"},
    {"REMEMBER x = 0\n" + rule("SET x := 4"), "SET x TO 4"},
    {"x := 4\n", "REMEMBER x = 4"},
    {"let x = 4;\n" + rule("SHOW face happy;"), "RSL does not use `;`"},
    {"WHEN touch LEVEL < 3 {\n  SHOW face happy;\n}\n", "RSL has no braces"},
    // languages that people speak
    {"WENN touch LEVEL < 3 UND touch LEVEL > 1 DANN\n  SHOW face happy\nSONST\n  SHOW face sad\n"
     "ENDE\n",
     "`WHEN` instead of `WENN`, `AND` instead of `UND`, `DO` instead of `DANN`"},
    {rule("WENN touch LEVEL > 1 DANN\n    SHOW face happy\n  ENDE"), "`IF` instead of `WENN`"},
    {rule("WIEDERHOLE 3 MAL\n    SHOW face happy\n  ENDE"), "`TIMES` instead of `MAL`"},
    {"QUAND touch LEVEL < 3 FAIRE\n  SHOW face happy\nFIN\n", "`END` instead of `FIN`"},
    {"CUANDO touch LEVEL < 3 HACER\n  SHOW face happy\nFIN\n", "`WHEN` instead of `CUANDO`"},
    // a line of RSL with a part of another
    {"BEHAVIOR greet PRIORITY END\n", "BEHAVIOR greet PRIORITY 50"},
    {"BEHAVIOR greet PRIORITY END\n" + rule("SHOW face happy") + "END\n",
     "BEHAVIOR greet PRIORITY 50"},
};

}  // namespace

TEST_CASE("text of another language gives one error, which says how RSL writes it") {
  for (const Case& one : kCases) {
    const Result result = compile_text(one.program, common_robot());
    const std::string said = messages(result);
    INFO(one.program << '\n' << said);
    CHECK(result.diagnostics.errors() == 1);
    CHECK_THAT(said, Contains(one.says));
  }
}

TEST_CASE("a mistake beside the text of another language is reported, too") {
  const Result result = compile_text(
      "void loop() {\n  delay(500);\n}\n" + rule("SHOW face happy OR"), common_robot());
  CHECK(result.diagnostics.errors() == 2);
}

TEST_CASE("other languages' text in several places is one error with all its places") {
  const Result result = compile_text(rule("delay(500);") + rule("delay(9);"), common_robot());
  REQUIRE(result.diagnostics.errors() == 1);
  CHECK(result.diagnostics.all().front().labels.size() == 2);
}

TEST_CASE("semicolons are one error with their places") {
  const std::string line = "SHOW face happy;\n";
  const std::string six = line + line + line + line + line + "SHOW face happy;";
  const Result result = compile_text(rule(six), common_robot());
  REQUIRE(result.diagnostics.errors() == 1);
  CHECK(result.diagnostics.all().front().labels.size() == 4);
  CHECK_THAT(messages(result), Contains("it appears in 2 more places"));
}

TEST_CASE("semicolons at the ends of lines go by a fix that is certain") {
  const std::string right = rule("SHOW face happy\n  WAIT 1s % then; and\n\n  LOG \"a; b;\"");
  const std::string wrong =
      "WHEN touch LEVEL < 3 DO\n  SHOW face happy ;\n  WAIT 1s; % then; and\n;;\n  LOG \"a; b;\" ; "
      ";\nEND;\n";
  const Result result = compile_text(wrong, common_robot());
  REQUIRE(result.diagnostics.errors() == 1);
  std::string text = wrong;
  const auto& fixes = result.diagnostics.all().front().fixes;
  for (auto fix = fixes.rbegin(); fix != fixes.rend(); ++fix) {
    CHECK(fix->applicability == Applicability::certain);
    text.replace(fix->span.begin, fix->span.end - fix->span.begin, fix->replacement);
  }
  CHECK(text == right);
}

TEST_CASE("a semicolon between two statements has no fix that is certain") {
  const Result result = compile_text(rule("SHOW face happy; WAIT 1s"), common_robot());
  REQUIRE(result.diagnostics.errors() >= 1);
  for (const Diagnostic& one : result.diagnostics.all())
    for (const Fix& fix : one.fixes)
      CHECK(fix.applicability != Applicability::certain);
}

TEST_CASE("lines of RSL are not taken for those of another language") {
  for (const std::string& program : {
           "DEFINE fin\n  SHOW face happy\nEND\n" + rule("fin"),
           "REMEMBER mal = 0\n" + rule("SET mal TO 1"),
           std::string("CHECK size OF touch LEVEL\n  fin BELOW 3\n  alle OTHERWISE\nEND\n"
                       "WHEN size IS fin DO SHOW face happy END\n"),
           std::string("WHEN\n  mal > 3\nDO\n  SHOW face sad\nEND\nREMEMBER mal = 0\n"),
           std::string("LET pressed = 3\nWHEN touch LEVEL < pressed\nDO\n  SHOW face happy\nEND\n"),
       }) {
    const Result result = compile_text(program, common_robot());
    INFO(program << '\n' << messages(result));
    CHECK(result.diagnostics.errors() == 0);
  }
}

TEST_CASE("numbers and short blocks of RSL are not taken for BASIC or C") {
  for (const std::string& program : {
           std::string(
               "WHEN touch LEVEL > 5 THEN touch LEVEL < 2 WITHIN 2s\nDO SHOW face happy\nEND\n"),
           "STATE mood: calm, wild\n" + rule("SET mood TO calm"),
           std::string("REMEMBER x = 0\nWHEN touch LEVEL >\n  3 FOR 2s DO SET x TO 4 ELSE SET x TO "
                       "3 END\n"),
           std::string("LIST few: 1,\n  2\n") + rule("LOG ITEM 1 OF few"),
           rule("PICK ONE\n  OPTION 50%\n  SHOW face happy\n  OPTION 50%\n  SHOW face sad\n  END"),
       }) {
    const Result result = compile_text(program, common_robot());
    INFO(program << '\n' << messages(result));
    CHECK(result.diagnostics.errors() == 0);
  }
}

TEST_CASE("a call of what another module may define is no word of another language") {
  for (const char* const call : {"warte", "fin WITH 3"})
    CHECK_THAT(messages(compile_text(rule(call), common_robot())), !Contains("English"));
}

TEST_CASE("a name in robot.json that is a word of RSL is reported there only") {
  const std::string robot =
      R"({"sensors": [{"name": "when", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}}],
 "actuators": [{"name": "left_arm", "type": "PWM", "pin": 10, "device": "servo"}]})";
  const Result result = compile_text(
      "WHEN when LEVEL > 3 DO\n  MOVE left_arm UP\nEND\nWHEN when LEVEL < 2 DO\n  LOG \"a\"\nEND\n",
      robot);
  CHECK(result.diagnostics.errors() == 1);
  CHECK_THAT(messages(result), Contains("E0102"));
}
