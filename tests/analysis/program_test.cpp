// Response times of whole programs: against a simulation of their task sets, and what
// `rsc check --timing` says of those that the board cannot keep up with.
#include <random>

#include <catch2/catch.hpp>

#include "analysis/report.hpp"
#include "analysis/task_set.hpp"
#include "rsc/board.hpp"
#include "tests/analysis/simulation.hpp"
#include "tests/rsc/process.hpp"
#include "tests/timing/programs.hpp"

using namespace robosync;
using Catch::Contains;

namespace {

const char* const kRobot = R"({
  "sensors": [
    {"name": "touch", "type": "I2C", "bus": 0, "address": "0x70", "device": "max34451",
     "channels": {"LEVEL": {"input": 0, "range": [0, 10], "rate": "RATE"}}}
  ],
  "actuators": [{"name": "arm", "type": "PWM", "pin": "10", "device": "servo", "range": ["0deg", "90deg"]}]
})";

const char* const kProgram = R"(WHEN touch LEVEL > 3
DO
  MOVE arm QUICKLY
END
)";

test::Outcome check_at(const std::string& rate) {
  std::string robot = kRobot;
  robot.replace(robot.find("RATE"), 4, rate);
  test::Folder folder;
  folder.write("robot.json", robot);
  const std::string file = folder.write("robot.rsl", kProgram);
  return test::rsc({"check", "--timing", file});
}

}  // namespace

TEST_CASE("examples: no simulated release takes longer than is printed") {
  std::mt19937 random(1);
  for (const auto& entry : std::filesystem::directory_iterator(test::kRoot / "examples")) {
    const std::string file = "examples/" + entry.path().filename().string() + "/robot.rsl";
    if (!std::filesystem::exists(test::kRoot / file)) continue;
    INFO(file);
    const tool::Program program = test::compile_example(file);
    const analysis::TaskSet set = analysis::task_set_of(program.image(), tool::board_costs());
    CHECK(analysis::response_report(program.image(), tool::board_costs()).schedulable());
    for (unsigned p = 0; p < 100; ++p) {
      test::Pattern pattern;
      for (const analysis::Source& source : set.sources)
        pattern.first.push_back(source.follows == analysis::Source::kNone ? 1 + random() % 20'000
                                                                          : ~test::Time{0});
      for (const analysis::Interference& one : set.interferences)
        pattern.interference_first.push_back(1 + random() % one.period);
      pattern.behaviors_begin = 2'000;
      pattern.follow_delay = 16'000;
      const auto seen = test::simulate(set, pattern, 1'000'000, random);
      for (std::size_t s = 0; s < seen.size(); ++s) {
        const analysis::ResponseTime said =
            analysis::response_time_of(set, s, analysis::Priorities::base);
        if (said.bounded) CHECK(seen[s] <= said.time);
      }
    }
  }
}

TEST_CASE("adapted priorities make nothing shorter") {
  const tool::Program program = test::compile_example("examples/tickle_companion/robot.rsl");
  const analysis::ResponseReport report =
      analysis::response_report(program.image(), tool::board_costs(), 99);
  REQUIRE_FALSE(report.paths.empty());
  for (const analysis::PathTiming& path : report.paths)
    CHECK((!path.adapted.bounded || path.adapted.time >= path.base.time));
}

TEST_CASE("adapted priorities: robot.json says so, and each path is told for both") {
  std::string robot = kRobot;
  robot.replace(robot.find("RATE"), 4, "50Hz");
  robot.insert(robot.find('{') + 1, R"("scheduler": {"alpha": 2, "window": "1s", "cap": 90},)");
  test::Folder folder;
  folder.write("robot.json", robot);
  const test::Outcome outcome =
      test::rsc({"check", "--timing", folder.write("robot.rsl", kProgram)});
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.out, Contains("touch -> arm") && Contains("adapted to P_max"));
}

TEST_CASE("check --timing: a sensor that is read too often is refused, and why") {
  const test::Outcome good = check_at("50Hz");
  CHECK(good.exit == 0);
  CHECK_THAT(good.out, Contains("touch -> arm") && Contains("the processor, all of it"));

  const test::Outcome bad = check_at("1000Hz");
  CHECK(bad.exit == 1);
  CHECK_THAT(bad.err, Contains("the board cannot keep up") && Contains("touch") &&
                          Contains("of the processor") && Contains("lower rate"));
  CHECK_FALSE(bad.out.empty());
}
