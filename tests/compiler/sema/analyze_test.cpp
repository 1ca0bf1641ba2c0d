// What sema makes of a program: the structure that codegen gets.
#include "compiler/sema/analyze.hpp"

#include <catch2/catch.hpp>

#include "compiler/config/robot_reader.hpp"
#include "compiler/ir/walk.hpp"
#include "compiler/syntax/parser.hpp"
#include "tests/compiler/compiled.hpp"

using namespace robosync;
using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

ir::Program analyzed(const std::string& text) {
  SourceMap sources;
  Diagnostics diagnostics;
  const FileId program_file = sources.add("robot.rsl", text);
  const FileId robot_file = sources.add("robot.json", common_robot());
  const ast::Tree tree = parse(sources, program_file, diagnostics);
  const auto robot = read_robot(sources, robot_file, diagnostics);
  REQUIRE(robot.has_value());
  ir::Program program = analyze({&tree}, *robot, sources, diagnostics);
  INFO(render_human(diagnostics, sources, false));
  REQUIRE(diagnostics.errors() == 0);
  return program;
}

std::string rule(const std::string& condition, const std::string& body = "MOVE left_arm SLOWLY") {
  return "WHEN " + condition + "\nDO\n" + body + "\nEND\n";
}

// The condition of the only rule.
Expression condition_of(const std::string& text, const std::string& before = "") {
  const ir::Program program = analyzed(before + rule(text));
  REQUIRE(program.behaviors.size() == 1);
  return program.behaviors[0].rules[0].condition;
}

// The response of the only rule.
ir::Block response_of(const std::string& body, const std::string& around = "") {
  const ir::Program program = analyzed(around + rule("touch LEVEL > 3", body));
  REQUIRE(program.behaviors.size() == 1);
  return program.behaviors[0].rules[0].then_response;
}

}  // namespace

TEST_CASE("MARGIN: enter at the number, leave later, for every comparison of its kind") {
  const Expression latch = condition_of("room WARMTH > 60C MARGIN 5C");
  REQUIRE(latch.operation == Operation::latch);
  CHECK(latch.operands[0].operation == Operation::greater);
  CHECK(latch.operands[0].operands[1].constant == 60'000);
  CHECK(latch.operands[1].operation == Operation::greater_equal);
  CHECK(latch.operands[1].operands[1].constant == 55'000);
  const Expression mirrored = condition_of("60C < room WARMTH MARGIN 9F");
  CHECK(mirrored.operands[1].operation == Operation::less_equal);
  CHECK(mirrored.operands[1].operands[0].constant == 55'000);
  const Expression both = condition_of("room WARMTH > 60C AND touch LEVEL < 3 MARGIN 5C");
  CHECK(both.operands[0].operation == Operation::latch);
  CHECK(both.operands[1].operation == Operation::less);
  const Expression between = condition_of("room WARMTH IS BETWEEN 20C AND 30C MARGIN 5C");
  REQUIRE(between.operation == Operation::latch);
  const auto limits = [](const Expression& two) {
    CHECK(two.operation == Operation::logical_and);
    return std::pair(two.operands[0].operands[1].constant, two.operands[1].operands[1].constant);
  };
  CHECK(limits(between.operands[0]) == std::pair(20'000, 30'000));
  CHECK(limits(between.operands[1]) == std::pair(15'000, 35'000));
}

TEST_CASE("time words become operations with their durations") {
  CHECK(condition_of("touch LEVEL > 3 FOR 2s").operation == Operation::held);
  CHECK(condition_of("touch LEVEL > 3 FOR 2s").constant == 2'000);
  const Expression counted = condition_of("touch LEVEL > 3 3 TIMES WITHIN 2s");
  CHECK(counted.operation == Operation::counted);
  CHECK(counted.index == 3);
  CHECK(condition_of("touch LEVEL > 3 THEN touch LEVEL < 1 WITHIN 1s").operands.size() == 2);
  CHECK(condition_of("touch LEVEL CHANGES BY 2").constant == 2'000);
  const Expression becomes = condition_of("mood BECOMES sad", "STATE mood: calm, sad\n");
  REQUIRE(becomes.operation == Operation::rose);
  CHECK(becomes.operands[0].operands[1].constant == 1'000);
}

TEST_CASE("bands meet, and hold on to their values up to the MARGIN") {
  const ir::Program program = analyzed(
      "CHECK space OF proximity DISTANCE\n very close BELOW 30cm\n close BELOW 120cm\n"
      " far OTHERWISE\n MARGIN 5cm\n SMOOTH OVER 200ms\nEND\n" +
      rule("space IS very close"));
  REQUIRE(program.checks.size() == 1);
  const ir::Check& check = program.checks[0];
  CHECK(check.window == 10);
  REQUIRE(check.bands.size() == 3);
  CHECK(check.bands[0].high == 299'999);
  CHECK(check.bands[0].stay_high == 350'000);
  // It gives way to the band before it at the number written there.
  CHECK(check.bands[1].low == 300'000);
  CHECK(check.bands[1].stay_low == 300'000);
  CHECK(check.bands[1].high == 1'199'999);
  CHECK(check.bands[1].stay_high == 1'250'000);
  CHECK(check.bands[2].low == 1'200'000);
  CHECK(check.bands[2].stay_low == 1'200'000);
  CHECK(program.variables[0].labels == std::vector<std::string>{"very close", "close", "far"});
  CHECK(program.variables[0].initial == vm::kUnknown);
}

TEST_CASE("a band with another in its middle holds on to nothing") {
  const ir::Program program = analyzed(
      "CHECK tone OF touch LEVEL\n concert BETWEEN 4 AND 5\n other OTHERWISE\n MARGIN 1\nEND\n" +
      rule("tone IS concert"));
  const vm::Band& other = program.checks[0].bands[1];
  CHECK(other.low == vm::kValueMin);
  CHECK(other.stay_low > other.stay_high);
}

TEST_CASE("a FEELING fades so that 5 % are left after its time") {
  const ir::Program program = analyzed(
      "FEELING joy FROM 0% TO 100% START 50%\n FADES TO 20% OVER 100ms\n"
      "FEELING fear FROM 0% TO 100% START 0%\n FADES TO 0% OVER 20s\n" +
      rule("joy > fear"));
  CHECK(program.variables[0].fade == 107'374'182);  // 0.05 * 2^31
  CHECK(program.variables[0].fades_to == 20'000);
  CHECK(program.variables[1].fade == 2'115'556'924);  // 0.05 ^ (1/200) * 2^31
}

TEST_CASE("a constant stands for its parameter, another value is worked out once") {
  const std::string define =
      "DEFINE nod WITH angle, beat\n MOVE left_arm TO angle OVER beat\n"
      " MOVE right_arm TO angle OVER beat\nEND\n"
      "REMEMBER far = 10deg\n";
  const ir::Block constant = response_of("nod WITH 20deg, 300ms", define);
  REQUIRE(constant.size() == 2);
  CHECK(std::get<ir::Command>(constant[0].node).arguments[0].value.constant == 20'000);
  const ir::Block worked_out = response_of("nod WITH far * 2, 300ms\nnod WITH far, 1s", define);
  REQUIRE(worked_out.size() == 6);
  CHECK(std::get<ir::Local>(worked_out[0].node).number == 0);
  const Expression& use = std::get<ir::Command>(worked_out[2].node).arguments[0].value;
  CHECK(use.operation == Operation::local);
  CHECK(use.index == 0);
  CHECK(std::get<ir::Local>(worked_out[3].node).number == 1);
}

namespace {

std::size_t readings(const Expression& expression) {
  std::size_t count = expression.operation == Operation::input ? 1 : 0;
  for (const Expression& operand : expression.operands)
    count += readings(operand);
  return count;
}

std::size_t readings(const ir::Block& block) {
  std::size_t count = 0;
  for_each_statement(block, [&](const ir::Statement& statement) {
    for_each_expression(statement,
                        [&](const Expression& expression) { count += readings(expression); });
  });
  return count;
}

}  // namespace

TEST_CASE("what a FOLLOW follows is worked out anew, though it is a parameter") {
  const std::string defines =
      "DEFINE track WITH arm, goal\n FOLLOW arm TO (goal / 2) AT 30deg/s\nEND\n"
      "DEFINE both WITH goal\n track WITH left_arm, goal + 1deg\n track WITH right_arm, "
      "goal\nEND\n";
  const ir::Block block = response_of("both WITH touch LEVEL * 2deg", defines);
  const auto* const follow = std::get_if<ir::Follow>(&block.back().node);
  REQUIRE(follow != nullptr);
  CHECK(readings(follow->body) == 2);  // both go on together, each reads for itself
  const ir::Block once =
      response_of("look WITH touch LEVEL * 2deg",
                  "DEFINE look WITH goal\n MOVE left_arm TO goal\n MOVE right_arm TO goal\nEND\n");
  CHECK(readings(once) == 1);
}

TEST_CASE("what is followed may be handed on, but not grow without end") {
  const auto program = [](const std::string& last) {
    std::string text = "DEFINE d30 WITH angle\n " + last + " left_arm TO angle\nEND\n" +
                       rule("touch LEVEL > 3", "d0 WITH touch LEVEL * 1deg");
    for (int i = 0; i < 30; ++i)
      text += "DEFINE d" + std::to_string(i) + " WITH angle\n d" + std::to_string(i + 1) +
              " WITH angle + angle\nEND\n";
    return text;
  };
  CHECK(!compile_text(program("MOVE"), common_robot()).image.empty());
  const Result result = compile_text(program("FOLLOW"), common_robot());
  CHECK(result.image.empty());
  CHECK(messages(result).find("cannot be recalculated all the time") != std::string::npos);
}

TEST_CASE("SET, RAISE, LOWER and SIGNAL") {
  const ir::Block block =
      response_of("SET mood TO very sad\nRAISE n BY 2\nLOWER n BY 3\nSIGNAL bell",
                  "STATE mood: calm, very sad\nREMEMBER n = 0\n");
  CHECK(std::get<ir::Set>(block[0].node).value.constant == 1'000);
  CHECK_FALSE(std::get<ir::Set>(block[0].node).relative);
  CHECK(std::get<ir::Set>(block[1].node).relative);
  CHECK(std::get<ir::Set>(block[2].node).value.constant == -3'000);
  CHECK(std::get<ir::Set>(block[3].node).value.constant == 1);
}

TEST_CASE("PICK ONE: shares as given, or equal ones") {
  const ir::Block block = response_of(
      "PICK ONE\n OPTION 60%\n THEN\n OPTION 40%\n THEN\nEND\n"
      "PICK ONE\n OPTION\n THEN\n OPTION\n THEN\nEND");
  const auto weights = [&](std::size_t i) {
    std::vector<vm::Value> result;
    for (const ir::Option& option : std::get<ir::Pick>(block[i].node).options)
      result.push_back(option.weight);
    return result;
  };
  CHECK(weights(0) == std::vector<vm::Value>{60'000, 40'000});
  CHECK(weights(1) == std::vector<vm::Value>{1'000, 1'000});
}

TEST_CASE("LOG joins its parts into one text") {
  const ir::Block block = response_of("LOG \"at\", proximity DISTANCE, \"now\"");
  const auto& log = std::get<ir::Log>(block[0].node);
  CHECK(log.text == "at {cm} now");
  CHECK(log.values.size() == 1);
  const auto text = [](const std::string& line) {
    return std::get<ir::Log>(response_of(line)[0].node).text;
  };
  CHECK(text("LOG 90s, 1m + proximity DISTANCE, touch LEVEL, 3, \"{x} }{ {\"") ==
        "{s} {m} {} {} {x} }{ {");
}

TEST_CASE("LIMIT: a speed, or a SAFETY rule for what a sensor measures") {
  const ir::Program program = analyzed(
      "LIMIT arms SPEED TO 60deg/s\nLIMIT left_arm SPEED TO 90deg/s\n" + rule("touch LEVEL > 3"));
  REQUIRE(program.speed_limits.size() == 2);
  CHECK(program.speed_limits[0] == std::pair<std::size_t, vm::Value>{0, 60'000});
  CHECK(program.speed_limits[1] == std::pair<std::size_t, vm::Value>{1, 60'000});
}

TEST_CASE("rules: kinds, modifiers, priorities") {
  const ir::Program program = analyzed(
      "EVERY 3s TO 7s\nDO BLINK lamp\nEND\nAT START\nDO BLINK lamp\nEND\n"
      "WHILE touch LEVEL > 3 PRIORITY 7 COOLDOWN 2s\nDO BLINK lamp\nEND\n"
      "WHEN touch LEVEL > 3 RESTARTING WAITING 1s\nDO BLINK lamp\nEND\n");
  REQUIRE(program.behaviors.size() == 4);
  CHECK(program.behaviors[0].priority == 7);
  CHECK(program.behaviors[0].rules[0].kind == vm::RuleKind::while_);
  CHECK(program.behaviors[0].rules[0].cooldown == 2'000);
  CHECK(program.behaviors[1].rules[0].kind == vm::RuleKind::every);
  CHECK(program.behaviors[1].rules[0].condition.operation == Operation::random);
  CHECK(program.behaviors[2].rules[0].kind == vm::RuleKind::start);
  CHECK(program.behaviors[3].rules[0].restarting);
  CHECK(program.behaviors[3].rules[0].waiting == 1'000);
}

namespace {

Result with_module(const std::string& program, const std::string& module) {
  const ModuleReader read = [&](const std::string& user,
                                const std::string& file) -> std::optional<Input> {
    if (user != "robot.rsl" || file != "own.rsl") return std::nullopt;
    return Input{"own.rsl", module};
  };
  return compile({"robot.rsl", program}, {"robot.json", common_robot()},
                 {.source_lines = true, .read_module = read});
}

}  // namespace

TEST_CASE("a module gives its names; what nobody runs of it need not fit the robot") {
  const std::string module =
      "LET reach = 30deg\nDEFINE nod WITH angle\n MOVE left_arm TO angle\nEND\n"
      "DEFINE fly\n FLAP wings\nEND\n";
  const Result good = with_module(
      "USE \"own.rsl\"\nUSE \"own.rsl\"\n" + rule("touch LEVEL > 3", "nod WITH reach"), module);
  INFO(messages(good));
  CHECK(good.diagnostics.all().empty());
  CHECK(!good.image.empty());
  const Result run = with_module("USE \"own.rsl\"\n" + rule("touch LEVEL > 3", "fly"), module);
  CHECK(run.image.empty());
  CHECK(messages(run).find("own.rsl:6:2") != std::string::npos);
  const Result commented =
      with_module("USE \"own.rsl\"\nUSE \"own.rsl\"\n" + rule("touch LEVEL > 3", "nod WITH reach"),
                  module + "# more\n");
  CHECK(view(good).header->program_hash == view(commented).header->program_hash);
  const Result changed = with_module(
      "USE \"own.rsl\"\nUSE \"own.rsl\"\n" + rule("touch LEVEL > 4", "nod WITH reach"), module);
  CHECK(view(good).header->program_hash != view(changed).header->program_hash);
}

TEST_CASE("a file that is no module is one error, not one for each of its lines") {
  const std::string program = "USE \"own.rsl\"\n" + rule("touch LEVEL > 3", "nod");
  std::string other = "# users\n";
  for (int i = 0; i < 10; ++i)
    other += "list" + std::to_string(i) + ":x:38:38:Mailing List:/bin/sh\n";
  const Result wrong = with_module(program, other);
  INFO(messages(wrong));
  CHECK(wrong.diagnostics.errors() == 1);
  CHECK(wrong.diagnostics.all().front().code == Code::E0410);
  std::string own;
  for (int i = 0; i < 10; ++i)
    own += "DEFINE nod" + std::to_string(i) + "\n MOVE left_arm TO TO 3deg\nEND\n";
  const Result misspelt = with_module(program, own);
  INFO(messages(misspelt));
  CHECK(misspelt.diagnostics.errors() >= 10);
}

TEST_CASE("two modules that bring one name: both places, and a way out") {
  const Result both =
      with_module("USE gestures\nUSE \"own.rsl\"\n" + rule("touch LEVEL > 3", "PERFORM nod"),
                  "MOTION nod OF left_arm\n AT 300ms 60deg\nEND\n");
  CHECK(both.image.empty());
  CHECK(messages(both).find("the name `nod` is given twice") != std::string::npos);
  CHECK(messages(both).find("<gestures>:") != std::string::npos);
  CHECK(messages(both).find("use only one of the two modules") != std::string::npos);
}

TEST_CASE("a MOTION of a module needs the actuators that it moves when somebody performs it") {
  const std::string module =
      "MOTION wave OF left_arm\n AT 300ms 60deg\n AT 600ms 0deg\nEND\n"
      "MOTION flap OF wings\n AT 300ms 60deg\nEND\n";
  const auto with = [&](const std::string& motion) {
    return with_module("USE \"own.rsl\"\n" + rule("touch LEVEL > 3", "PERFORM " + motion), module);
  };
  const Result good = with("wave 2 TIMES");
  INFO(messages(good));
  CHECK(good.diagnostics.all().empty());
  CHECK(!good.image.empty());
  const Result bad = with("flap");
  CHECK(bad.image.empty());
  REQUIRE(bad.diagnostics.errors() == 1);
  CHECK(messages(bad).find("there is no actuator `wings`\n  --> robot.rsl:4:9") !=
        std::string::npos);
  CHECK(messages(bad).find("--> own.rsl:5:16") != std::string::npos);
}

TEST_CASE("DEFINEs that grow without end are refused, not expanded") {
  std::string program = rule("touch LEVEL > 3", "d0 WITH 1deg");
  for (int i = 0; i < 60; ++i) {
    const std::string next = "d" + std::to_string(i + 1) + " WITH angle\n";
    program += "DEFINE d" + std::to_string(i) + " WITH angle\n" + next + next + "END\n";
  }
  program += "DEFINE d60 WITH angle\n MOVE left_arm TO angle\nEND\n";
  const Result result = compile_text(program, common_robot());
  CHECK(result.image.empty());
  CHECK(messages(result).find("E0407") != std::string::npos);
}

TEST_CASE("a response may not give an actuator more commands than can wait for it") {
  const auto times = [](unsigned count, const std::string& text) {
    std::string all;
    for (unsigned i = 0; i < count; ++i)
      all += text;
    return all;
  };
  const auto refused = [](const std::string& response) {
    const Result result = compile_text(rule("touch LEVEL > 3", response), common_robot());
    if (result.diagnostics.errors() == 0) return false;
    INFO(messages(result));
    CHECK(result.diagnostics.errors() == 1);
    CHECK(messages(result).find("8 commands for `left_arm` are still waiting here") !=
          std::string::npos);
    return true;
  };
  const std::string move = "MOVE left_arm SLOWLY\n";
  CHECK_FALSE(refused(times(8, move)));
  CHECK(refused(times(9, move)));
  CHECK(refused(times(4, move) + times(5, "MOVE arms SLOWLY\n")));
  for (const char* const pause : {"THEN\n", "WAIT 1s\n", "STOP left_arm\n",
                                  "FOLLOW left_arm TO (touch LEVEL * 1deg) FOR 1s\n"})
    CHECK_FALSE(refused(times(8, move) + pause + times(8, move)));
  CHECK_FALSE(refused("REPEAT 4 TIMES\n" + times(2, move) + "END\n"));
  CHECK(refused("REPEAT 5 TIMES\n" + times(2, move) + "END\n"));
  CHECK(refused(times(7, move) + "REPEAT 2 TIMES\n" + move + "THEN\n" + times(8, move) + "END\n"));
  CHECK_FALSE(refused("REPEAT 100 TIMES\n" + times(8, move) + "THEN\nEND\n"));
  const std::string either =
      "IF touch LEVEL > 5\nDO\n" + times(5, move) + "ELSE\n" + times(5, move) + "END\n";
  CHECK_FALSE(refused(either + times(3, move)));
  CHECK(refused(either + times(4, move)));
  const auto sides = [&](const std::string& first, const std::string& second) {
    return "IF touch LEVEL > 5\nDO\n" + first + "ELSE\n" + second + "END\n";
  };
  CHECK_FALSE(refused(times(8, move) + sides("THEN\n", "WAIT 1s\n") + times(8, move)));
  CHECK(refused(times(8, move) + sides("THEN\n", "LOG \"a\"\n") + move));
  CHECK_FALSE(refused(times(8, move) + "PICK ONE\nOPTION 50%\nTHEN\nOPTION 50%\nWAIT 1s\nEND\n" +
                      times(8, move)));
  CHECK(refused(times(8, move) + "IF touch LEVEL > 5\nDO\nTHEN\nEND\n" + move));
  const Result ending = compile_text(
      "WHEN touch LEVEL > 3 DO\nMOVE right_arm SLOWLY\nELSE\n" + times(9, move) + "END\n",
      common_robot());
  CHECK(ending.diagnostics.errors() == 1);
}

TEST_CASE("actuators, groups, texts and DEFINEs stand for their parameters") {
  const std::string defines =
      "DEFINE wave WITH arm, item\nMOVE arm SLOWLY\nPLAY sound item\nSTOP arm\nEND\n"
      "DEFINE outer WITH action, who\naction WITH who, \"warning.wav\"\nEND\n";
  const ir::Block given = response_of("outer WITH wave, arms", defines);
  const ir::Block written = response_of("MOVE arms SLOWLY\nPLAY sound \"warning.wav\"\nSTOP arms");
  REQUIRE(given.size() == written.size());
  for (std::size_t i = 0; i < given.size(); ++i) {
    const auto& one = std::get<ir::Command>(given[i].node);
    const auto& other = std::get<ir::Command>(written[i].node);
    CHECK(one.actuators == other.actuators);
    CHECK(one.group == other.group);
    CHECK(one.verb == other.verb);
    CHECK(one.word == other.word);
  }
}
