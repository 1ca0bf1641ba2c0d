// rsc check --timing: its figures are the verifier's, its table and its JSON say the same.
#include "rsc/timing.hpp"

#include <numeric>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "runtime-m4/boards/memory.hpp"
#include "tests/rsc/process.hpp"
#include "tests/timing/programs.hpp"
#include "vm/opcode.hpp"

using namespace robosync;
using Catch::Contains;
using nlohmann::json;

namespace {

std::uint32_t cost(vm::Opcode opcode) {
  return vm::kOpcodes[static_cast<std::size_t>(opcode)].cost;
}

const char* const kThreeRules = R"(BEHAVIOR first PRIORITY 20
  WHEN touch LEVEL > 3 DO
    MOVE arms SLOWLY
  ELSE
    MOVE arms QUICKLY
    MOVE arms SLOWLY
  END
END

BEHAVIOR second PRIORITY 70
  AT START DO
    MOVE arms QUICKLY
  END
END
)";

// Needs more than the board's budget, but less than the format allows.
std::string dear_program(const std::string& rounds) {
  return "REMEMBER n = 0\n"
         "WHEN touch LEVEL > 1 DO\n  MOVE arms SLOWLY\nEND\n"
         "WHEN touch LEVEL > 2 DO\n  REPEAT " +
         rounds +
         " TIMES\n    SET n TO n / 3 + touch LEVEL\n  END\nEND\n"
         "WHEN touch LEVEL > 3 DO\n  REPEAT 9 TIMES\n    SET n TO n / 3\n  END\nEND\n"
         "WHEN touch LEVEL > 4 DO\n  SET n TO 4\nEND\n";
}

struct Robot : test::Folder {
  explicit Robot(const std::string& program) {
    write("robot.json", testing::read_file(test::kRoot / "docs/robot.json"));
    file = write("robot.rsl", program);
  }
  std::string file;
};

}  // namespace

TEST_CASE("the costs of the rules are those of their code, and their sum is the step's") {
  const tool::Program program = test::compile_with_docs_robot(kThreeRules);
  const tool::Timing timing = tool::timing_of(program.image());
  CHECK(timing.step.used == program.image().header->step_cost);
  CHECK(timing.step.limit == boards::kMemory.step_budget);
  REQUIRE(timing.behaviors.size() == 2);  // as in the source, not by priority
  CHECK(timing.behaviors[0].name == "first");
  CHECK(timing.behaviors[1].name == "second");

  const tool::RuleTiming& rule = timing.behaviors[0].rules.at(0);
  CHECK(rule.line == 2);
  CHECK(rule.cost.condition == cost(vm::Opcode::gt_k) + cost(vm::Opcode::ret));
  CHECK(rule.cost.then_response == cost(vm::Opcode::cmd_end));
  CHECK(rule.cost.else_response == cost(vm::Opcode::cmd) + cost(vm::Opcode::cmd_end));
  CHECK(rule.else_is_worst);
  CHECK(rule.response_line == 5);
  CHECK(timing.behaviors[0].step == rule.cost.condition + rule.cost.else_response);

  const tool::RuleTiming& start = timing.behaviors[1].rules.at(0);
  CHECK(start.cost.condition == 0);
  CHECK_FALSE(start.else_is_worst);
}

TEST_CASE("every example's rules cost what its header says of a step") {
  for (const auto& entry : std::filesystem::directory_iterator(test::kRoot / "examples")) {
    const std::string file = "examples/" + entry.path().filename().string() + "/robot.rsl";
    if (!std::filesystem::exists(test::kRoot / file)) continue;
    INFO(file);
    const tool::Program program = test::compile_example(file);
    const tool::Timing timing = tool::timing_of(program.image());
    CHECK(timing.step.used == program.image().header->step_cost);
    const auto sections = [](std::size_t sum, const auto& size) { return sum + size.bytes; };
    CHECK(std::accumulate(timing.sections.begin(), timing.sections.end(), std::size_t{0},
                          sections) == tool::without_source_lines(program).size());
  }
}

TEST_CASE("rule_costs() gives nothing for code that the verifier refuses") {
  const tool::Program program = test::compile_with_docs_robot(kThreeRules);
  std::vector<vm::RuleCost> costs(program.image().rules.size());
  CHECK(vm::rule_costs(program.image(), costs));
  CHECK_FALSE(vm::rule_costs(program.image(), std::span(costs).first(1)));

  std::vector<std::byte> bytes(program.bytes().begin(), program.bytes().end());
  const auto code = reinterpret_cast<const std::byte*>(program.image().code.data());
  bytes[static_cast<std::size_t>(code - program.bytes().data())] = std::byte{255};
  vm::Image image;
  REQUIRE(vm::view_image(bytes, image));
  CHECK_FALSE(vm::rule_costs(image, costs));
}

TEST_CASE("check --timing: the table and the JSON") {
  const Robot robot(kThreeRules);
  const test::Outcome table = test::rsc({"check", "--timing", robot.file});
  CHECK(table.exit == 0);
  CHECK_THAT(table.out, Contains("BEHAVIOR first PRIORITY 20") && Contains("ELSE line 5") &&
                            Contains("when/else") && Contains("of 100000 instructions"));

  const test::Outcome outcome = test::rsc({"check", "--timing", robot.file, "--format", "json"});
  CHECK(outcome.exit == 0);
  const json report = json::parse(outcome.out);
  CHECK(report.at("errors") == 0);
  const json& timing = report.at("timing").at(0);
  CHECK(timing.at("behaviors").at(0).at("rules").at(0).at("worst") ==
        json({{"side", "else"}, {"line", 5}}));
  std::uint32_t sum = 0;
  for (const json& behavior : timing.at("behaviors"))
    for (const json& rule : behavior.at("rules"))
      sum += rule.at("step").get<std::uint32_t>();
  CHECK(timing.at("step").at("used") == sum);
  CHECK_THAT(table.out, Contains(std::to_string(sum) + " of 100000 instructions"));
}

TEST_CASE("a step that costs too much: which rules, and what to do, from every verb") {
  const Robot robot(dear_program("5000"));
  const auto says = [](const std::string& text) {
    CHECK_THAT(text, Contains("line 5: ") && Contains("in its DO (line 6)") &&
                         Contains("line 10: ") && Contains("line 15: ") && !Contains("line 2: ") &&
                         Contains("WAIT in it"));
    CHECK(text.find("line 5: ") < text.find("line 10: "));
    CHECK(text.find("line 10: ") < text.find("line 15: "));
  };
  const std::string image = robot.file + ".rsb";
  for (const std::vector<std::string>& verb :
       {std::vector<std::string>{"check"}, {"check", "--timing"}, {"compile", "-o", image}}) {
    std::vector<std::string> arguments = verb;
    arguments.push_back(robot.file);
    const test::Outcome outcome = test::rsc(arguments);
    CHECK(outcome.exit == 1);
    CHECK_THAT(outcome.err, Contains("E0407") && Contains("robot.rsl:5:1") &&
                                Contains("the board allows 100000") && Contains(" 10 | ") &&
                                Contains(" 15 | ") && Contains("WAIT in it"));
  }
  CHECK_FALSE(std::filesystem::exists(image));
  CHECK(test::rsc({"compile", "-o", image, "--anyway", robot.file}).exit == 0);
  const test::Outcome run = test::rsc({"run", robot.file});
  CHECK(run.exit == 1);
  says(run.err);
}

TEST_CASE("a step that no board may run is refused at the rules that cost most") {
  const Robot robot(dear_program("90000"));
  const test::Outcome outcome = test::rsc({"check", robot.file});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("E0407") && Contains("robot.rsl:6:3") &&
                              Contains("REPEAT 9 TIMES") && Contains("WAIT in it"));

  const Robot beyond(  // more than can be counted
      "REMEMBER n = 0\nWHEN touch LEVEL > 1 DO\n  REPEAT 90000 TIMES\n    REPEAT 90000 TIMES\n"
      "      SET n TO n / 3\n    END\n  END\nEND\n");
  const test::Outcome refused = test::rsc({"check", beyond.file});
  CHECK(refused.exit == 1);
  CHECK_THAT(refused.err, Contains("robot.rsl:3:3") && Contains("WAIT in it"));
}
